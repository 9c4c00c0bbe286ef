// SPDX-License-Identifier: Apache-2.0
// liquid_bridge.cpp: the plugin calx.liquid-bridge. The law itself is liquid_bridge.law.h; here are what the user sets,
// the pair row made of it, and up to which gap a bridge acts.
#define CALX_TERM liquid_bridge
#define CALX_TERM_TEXT "liquid_bridge.law.h"
#define CALX_TERM_BYTES "liquid_bridge.law.h.inc"
#define CALX_TERM_SHA256 "liquid_bridge.law.h.sha256.inc"
#include <calx/law/rolling_native.h>

#include <calx/law_term.hpp>
#include <cmath>

namespace {

constexpr double kPi = 3.14159265358979323846;

enum { TENSION, ANGLE, VOLUME, RELATIVE_VOLUME, FORMATION, VISCOSITY, LEAST_GAP };
const calx_field given[] = {
    {"surface_tension", "N/m", "surface tension of the liquid; water in air has 0.0728", 0, 10, 0.0728, 0, 0},
    {"contact_angle", "rad", "contact angle of the liquid on the grains", 0, 1.5, 0, 0, 0},
    {"volume", "m^3", "liquid in one bridge; 0: it follows from relative_volume", 0, 1e-3, 0, 0, 0},
    {"relative_volume", "1",
     "liquid in one bridge over R^3, R = 2 r_i r_j / (r_i + r_j), the radius of equal spheres; 0: it follows from "
     "volume",
     0, 0.1, 0, 0, 0},
    {"formation_distance", "m", "gap at which a bridge forms, the liquid films on both grains; 0: when they touch", 0,
     1, 0, 0, 0},
    {"viscosity", "Pa*s", "viscosity of the liquid; water has 0.001", 0, 1e4, 0, 0, 0},
    {"least_gap", "m", "gap below which viscous forces grow no more, the roughness of the grains", 1e-10, 1e-2, 1e-6, 0,
     0}};

liquid_bridge_pair_f64 row_of(const double* pair) {
  liquid_bridge_pair_f64 row;
  std::memcpy(&row, pair, offsetof(liquid_bridge_pair_f64, calx_unused));
  return row;
}

class LiquidBridge : public calx::LawTerm {
 public:
  static const calx_descriptor descriptor;

  LiquidBridge(const calx_host* host, const calx_config& config) : LawTerm(host, config) {
    table_.given = given;
    table_.given_count = sizeof given / sizeof *given;
    table_.derive = &derive;
    table_.stable_dt = &stable_dt;
    table_.reach = &reach;
  }

 private:
  static calx_status CALX_CALL derive(const calx_instance*, const calx_host* host, const double*, const double*,
                                      const double* value, double* pair) noexcept {
    if (value[VOLUME] > 0 && value[RELATIVE_VOLUME] > 0)
      return host->fail(host, CALX_E_CONFIG,
                        "\"volume\" and \"relative_volume\" both say how much liquid a bridge has; give one");
    // Lian, Thornton and Adams 1993: a bridge breaks at (1 + theta / 2) V^(1/3).
    const double longer = 1 + 0.5 * value[ANGLE];
    liquid_bridge_pair_f64 row;
    row.pull = 2 * kPi * value[TENSION] * std::cos(value[ANGLE]);
    row.spread = 2 / kPi * value[VOLUME];
    row.spread_share = 2 / kPi * value[RELATIVE_VOLUME];
    row.rupture = longer * std::cbrt(value[VOLUME]);
    row.rupture_share = longer * std::cbrt(value[RELATIVE_VOLUME]);
    row.formation = value[FORMATION];
    row.squeeze = 6 * kPi * value[VISCOSITY];
    row.least_gap = value[LEAST_GAP];
    std::memcpy(pair, &row, offsetof(liquid_bridge_pair_f64, calx_unused));
    return CALX_OK;
  }

  // Of the dashpot at the least gap. The pull falls with the gap, so it is no spring that could swing.
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double) noexcept {
    const liquid_bridge_pair_f64 row = row_of(pair);
    return calx_stable_step(m_eff, 0, row.squeeze * r_eff * r_eff / row.least_gap);
  }

  static double CALX_CALL reach(const double* pair, double r_i, double r_j) noexcept {
    const liquid_bridge_pair_f64 row = row_of(pair);
    return row.rupture + row.rupture_share * 2 * (r_j > 0 ? r_i * r_j / (r_i + r_j) : r_i);
  }
};

const calx_descriptor LiquidBridge::descriptor =
    calx::law_term("calx.liquid-bridge", "Liquid bridge", "1.0.0", "Calx", "Apache-2.0",
                   "Capillary and viscous forces of a liquid bridge, from forming until it breaks.");

}  // namespace

CALX_PLUGIN(LiquidBridge)
