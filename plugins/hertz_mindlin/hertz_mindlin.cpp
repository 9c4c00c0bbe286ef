// SPDX-License-Identifier: Apache-2.0
// hertz_mindlin.cpp: the plugin calx.hertz-mindlin. The law itself is hertz_mindlin.law.h; here are its tables, the
// numbers of a pair row from materials and given values, and the choice of one of the two laws of the text.
#include <calx/plugin.hpp>
#include <cmath>
#include <cstring>

// The text is compiled once in single and once in double precision; native.h makes a loop over columns of each law.
#define CALX_BITS 32
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "hertz_mindlin.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(hertz_mindlin)
CALX_LAW_BATCH(hertz_mindlin_rolling)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "hertz_mindlin.law.h"
#include <calx/law/native.h>
#include <calx/law/rolling_native.h>
CALX_LAW_BATCH(hertz_mindlin)
CALX_LAW_BATCH(hertz_mindlin_rolling)
CALX_LAW_TABLES(hertz_mindlin)
CALX_LAW_TABLES(hertz_mindlin_rolling)

namespace {

const char source[] = {
#include "hertz_mindlin.law.h.inc"
};
const char sha256[] =
#include "hertz_mindlin.law.h.sha256.inc"
    ;

// What the user may set. Options belong to the instance, material values to each material, given values to each pair;
// the case file holds options and given values in one object.
const calx_field options[] = {CALX_ROLLING_OPTION{"tension", "allowed|clipped",
                                                  "allowed: the dashpot may pull at the end of a contact, restitution "
                                                  "is exact; clipped: the normal force never pulls",
                                                  0, 1, 0, CALX_FIELD_CHOICE, 0},
                              {"tangential", "displacement|rescaled",
                               "what a growing contact keeps: the tangential displacement, as most codes do, or the "
                               "force, which never creates energy",
                               0, 1, 0, CALX_FIELD_CHOICE, 0}};
enum { YOUNG, POISSON };
const calx_field material[] = {{"young", "Pa", "Young's modulus", 1, 1e14, 1e7, CALX_FIELD_REQUIRED, 0},
                               {"poisson", "1", "Poisson's ratio", 0, 0.5, 0.25, CALX_FIELD_REQUIRED, 0}};
enum { RESTITUTION, FRICTION, ROLLING_FIRST };
const calx_field given[] = {
    {"restitution", "1", "speed after over speed before a head-on impact", 0, 1, 0.5, CALX_FIELD_REQUIRED, 0},
    {"friction", "1", "sliding friction, tangential over normal force", 0, 10, 0.5, CALX_FIELD_REQUIRED, 0},
    CALX_ROLLING_GIVEN};

class HertzMindlin : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  HertzMindlin(const calx_host*, const calx_config& config)
      : rolling_(static_cast<int>(calx::parameter(descriptor, config, "rolling"))),
        clipped_(calx::parameter(descriptor, config, "tension") > 0.5),
        rescaled_(calx::parameter(descriptor, config, "tangential") > 0.5) {
    std::memset(&table_, 0, sizeof table_);
    if (rolling_ == CALX_ROLLING_NONE)
      CALX_LAW_FILL(table_, hertz_mindlin);
    else
      CALX_LAW_FILL(table_, hertz_mindlin_rolling);
    table_.flags = CALX_LAW_EXACT;
    table_.material_count = sizeof material / sizeof *material;
    table_.material = material;
    table_.given_count = sizeof given / sizeof *given;
    table_.given = given;
    table_.derive = &derive;
    table_.stable_dt = &stable_dt;
    table_.source = source;
    table_.source_size = sizeof source - 1;
    table_.source_sha256 = sha256;
  }

  const void* get_interface(const char* id) const override {
    return std::strcmp(id, CALX_CONTACT_LAW) == 0 ? &table_ : nullptr;
  }

 private:
  // Effective moduli of two elastic bodies (Johnson 1985, eq. 4.20 and 7.46):
  //   1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j,   1/G* = (2-nu_i)/G_i + (2-nu_j)/G_j,   G = E / (2 (1+nu)).
  static calx_status CALX_CALL derive(const calx_instance* self, const calx_host* host, const double* material_i,
                                      const double* material_j, const double* value, double* pair) noexcept {
    return calx::guard(host, [&] {
      const HertzMindlin& law = *static_cast<const HertzMindlin*>(self);
      double inverse_e = 0, inverse_g = 0;
      for (const double* m : {material_i, material_j}) {
        const double young = m[YOUNG], poisson = m[POISSON];
        inverse_e += (1 - poisson * poisson) / young;
        inverse_g += 2 * (2 - poisson) * (1 + poisson) / young;
      }
      hertz_mindlin_pair_f64 row;
      row.two_e = 2 / inverse_e;
      row.eight_g = 8 / inverse_g;
      // beta = -ln e / sqrt(pi^2 + ln^2 e); its limit for e = 0 is 1.
      const double pi = 3.14159265358979323846;
      const double log_e = std::log(value[RESTITUTION]);
      const double beta = value[RESTITUTION] > 0 ? -log_e / std::sqrt(pi * pi + log_e * log_e) : 1;
      row.dash_n = 2 * std::sqrt(5.0 / 6.0) * beta * std::sqrt(row.two_e);
      row.dash_t = 2 * std::sqrt(5.0 / 6.0) * beta * std::sqrt(row.eight_g);
      row.friction = value[FRICTION];
      row.lowest = law.clipped_ ? 0 : -1e30;
      row.rescaled = law.rescaled_ ? 1 : 0;
      CALX_ROLLING_DERIVE(law.rolling_, value + ROLLING_FIRST, row);
      std::memcpy(pair, &row, law.table_.pair_count * sizeof *pair);
    });
  }

  // 0.17 sqrt(m / K): stable for a sphere held by many springs of stiffness K (O'Sullivan, Bray 2004). K is the tangent
  // stiffness at the largest expected overlap; S_t < S_n for every Poisson's ratio.
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) noexcept {
    hertz_mindlin_pair_f64 row;
    std::memcpy(&row, pair, offsetof(hertz_mindlin_pair_f64, calx_unused));
    return 0.17 * std::sqrt(m_eff / (row.two_e * std::sqrt(r_eff * overlap)));
  }

  int rolling_;
  bool clipped_, rescaled_;
  calx_contact_law table_;
};

const calx_descriptor HertzMindlin::descriptor = {
    sizeof(calx_descriptor),
    0,
    "calx.hertz-mindlin",
    CALX_CONTACT_LAW,
    "Hertz-Mindlin",
    "1.0.0",
    "Calx",
    "Apache-2.0",
    "Elastic spheres: Hertz force, dashpot, Mindlin spring with history, Coulomb friction, rolling resistance.",
    nullptr,
    options,
    sizeof options / sizeof *options,
    0,
    nullptr};

}  // namespace

CALX_PLUGIN(HertzMindlin)
