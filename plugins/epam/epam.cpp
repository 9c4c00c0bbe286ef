// SPDX-License-Identifier: Apache-2.0
// epam.cpp: the plugin calx.epam. The law itself is epam.law.h; here are its tables, the numbers of a pair row from
// materials and given values, and the choice of one of the six laws of the text.
#include <calx/plugin.hpp>

#include <cmath>
#include <cstring>

#define CALX_BITS 32
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "epam.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(epam_n1)
CALX_LAW_BATCH(epam_n15)
CALX_LAW_BATCH(epam_n1_rolling)
CALX_LAW_BATCH(epam_n15_rolling)
CALX_LAW_BATCH(epam_n1_chi)
CALX_LAW_BATCH(epam_n15_chi)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "epam.law.h"
#include <calx/law/native.h>
#include <calx/law/rolling_native.h>
CALX_LAW_BATCH(epam_n1)
CALX_LAW_BATCH(epam_n15)
CALX_LAW_BATCH(epam_n1_rolling)
CALX_LAW_BATCH(epam_n15_rolling)
CALX_LAW_BATCH(epam_n1_chi)
CALX_LAW_BATCH(epam_n15_chi)
CALX_LAW_TABLES(epam_n1)
CALX_LAW_TABLES(epam_n15)
CALX_LAW_TABLES(epam_n1_rolling)
CALX_LAW_TABLES(epam_n15_rolling)
CALX_LAW_TABLES(epam_n1_chi)
CALX_LAW_TABLES(epam_n15_chi)

namespace {

const char source[] = {
#include "epam.law.h.inc"
};
const char sha256[] =
#include "epam.law.h.sha256.inc"
    ;
const double pi = 3.14159265358979323846;

// Options belong to the instance, given values to each pair; the case file holds both in one object.
const calx_field options[] = {
    {"exponent", "1|1.5", "exponent n of the loading branches: 1 linear, 1.5 Hertzian", 0, 1, 1, CALX_FIELD_CHOICE, 0},
    {"adhesion_exponent", "same|1|1.5|2|2.5|3|3.5|4|4.5|5", "exponent chi of the adhesive branch; same: as exponent", 0,
     9, 0, CALX_FIELD_CHOICE, 0},
    {"adhesion_cap", "consistent|literal",
     "where half the unloading force limits adhesion: minimum on both branches, or at half the plastic overlap as "
     "LIGGGHTS",
     0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"adhesion_reload", "plastic|retrace",
     "reload from the adhesive branch: a new unloading line through the present point, or back along the branch", 0, 1,
     0, CALX_FIELD_CHOICE, 0},
    {"damping", "tsuji|literal_k1",
     "normal dashpot from the virgin tangent stiffness, or from the number k1 as LIGGGHTS; equal for exponent 1", 0, 1,
     0, CALX_FIELD_CHOICE, 0},
    {"dashpot", "compressive|clipped|always",
     "compressive: only where the branch force pushes; clipped: nor does it turn a push into a pull; always: no switch",
     0, 2, 0, CALX_FIELD_CHOICE, 0},
    {"tangential", "displacement|rescaled",
     "what a growing contact keeps: the tangential displacement, as most codes do, or the force, which never creates "
     "energy",
     0, 1, 0, CALX_FIELD_CHOICE, 0},
    CALX_ROLLING_OPTION};

enum { YOUNG, POISSON };
const calx_field material[] = {{"young", "Pa", "Young's modulus", 1, 1e14, 1e7, CALX_FIELD_REQUIRED, 0},
                               {"poisson", "1", "Poisson's ratio", 0, 0.5, 0.25, CALX_FIELD_REQUIRED, 0}};

enum { PLASTICITY, RESTITUTION, FRICTION, SURFACE_ENERGY, PULL_OFF, K_ADH, K1, TANGENTIAL_RATIO, ROLLING_FIRST };
// Units of k1 and k_adh and the preset of tangential_ratio depend on the exponents: each instance completes its copy.
const calx_field given[] = {
    {"plasticity", "1", "lambda = 1 - k1/k2: 0 elastic, towards 1 rigid unloading", 0, 0.99, 0.5, CALX_FIELD_REQUIRED,
     0},
    {"restitution", "1", "restitution of the elastic contact with its dashpot; plastic loss comes on top", 0, 1, 0.5,
     CALX_FIELD_REQUIRED, 0},
    {"friction", "1", "sliding friction, tangential over normal force", 0, 10, 0.5, CALX_FIELD_REQUIRED, 0},
    {"surface_energy", "J/m^2", "surface energy of the pair; pull-off grows with the plastic overlap", 0, 1e6, 0, 0, 0},
    {"pull_off", "N", "constant pull-off force f0, whatever the history", 0, 1e6, 0, 0, 0},
    {"k_adh", "", "fixed stiffness of the adhesive branch, instead of surface_energy", 0, 1e30, 0, 0, 0},
    {"k1", "", "virgin loading stiffness; 0: from young and poisson", 0, 1e15, 0, 0, 0},
    {"tangential_ratio", "1", "tangential stiffness over k1 (exponent 1) or over 8 G* sqrt(R* delta) (exponent 1.5)", 0,
     10, 0.67, 0, 0},
    CALX_ROLLING_GIVEN};
const uint32_t given_count = sizeof given / sizeof *given;

// By 2 chi, from 2 to 10.
const char* const stiffness_unit[] = {"",      "",        "N/m",   "N/m^1.5", "N/m^2", "N/m^2.5",
                                      "N/m^3", "N/m^3.5", "N/m^4", "N/m^4.5", "N/m^5"};

class Epam : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  Epam(const calx_host*, const calx_config& config) {
    hertz_ = choice(config, "exponent") == 1;
    const int chi = choice(config, "adhesion_exponent");
    const int own = hertz_ ? 3 : 2;
    chi2_ = chi == 0 ? own : chi + 1;
    literal_cap_ = choice(config, "adhesion_cap") == 1;
    retrace_ = choice(config, "adhesion_reload") == 1;
    tsuji_ = hertz_ && choice(config, "damping") == 0;
    dashpot_ = choice(config, "dashpot");
    rescaled_ = choice(config, "tangential") == 1;
    rolling_ = choice(config, "rolling");
    std::memset(&table_, 0, sizeof table_);
    if (chi2_ != own && hertz_)
      CALX_LAW_FILL(table_, epam_n15_chi);
    else if (chi2_ != own)
      CALX_LAW_FILL(table_, epam_n1_chi);
    else if (rolling_ != CALX_ROLLING_NONE && hertz_)
      CALX_LAW_FILL(table_, epam_n15_rolling);
    else if (rolling_ != CALX_ROLLING_NONE)
      CALX_LAW_FILL(table_, epam_n1_rolling);
    else if (hertz_)
      CALX_LAW_FILL(table_, epam_n15);
    else
      CALX_LAW_FILL(table_, epam_n1);
    std::memcpy(given_, given, sizeof given);
    given_[K_ADH].unit = stiffness_unit[chi2_];
    given_[K1].unit = stiffness_unit[own];
    given_[TANGENTIAL_RATIO].preset = hertz_ ? 0.67 : 2.0 / 7.0;
    table_.flags = CALX_LAW_EXACT;
    table_.material_count = sizeof material / sizeof *material;
    table_.material = material;
    table_.given_count = given_count;
    table_.given = given_;
    table_.derive = &derive;
    table_.stable_dt = hertz_ ? &stable_dt<3> : &stable_dt<2>;
    table_.source = source;
    table_.source_size = sizeof source - 1;
    table_.source_sha256 = sha256;
  }

  const void* get_interface(const char* id) const override {
    return std::strcmp(id, CALX_CONTACT_LAW) == 0 ? &table_ : nullptr;
  }

 private:
  static int choice(const calx_config& config, const char* name) {
    return static_cast<int>(calx::parameter(descriptor, config, name));
  }

  static calx_status CALX_CALL derive(const calx_instance* self, const calx_host* host, const double* material_i,
                                      const double* material_j, const double* value, double* pair) noexcept {
    return calx::guard(host, [&] {
      const Epam& law = *static_cast<const Epam*>(self);
      epam_n1_pair_f64 row;
      law.fill(material_i, material_j, value, &row);
      std::memcpy(pair, &row, law.table_.pair_count * sizeof *pair);
    });
  }

  void fill(const double* material_i, const double* material_j, const double* value, epam_n1_pair_f64* out) const {
    epam_n1_pair_f64& row = *out;
    const double lambda = value[PLASTICITY];
    if (!(lambda >= 0 && lambda <= 0.99))
      throw calx::ConfigError(
          "plasticity is " + std::to_string(lambda) +
          "; it must lie from 0 (elastic, k2 = k1) to 0.99 (k2 = 100 k1), so that k2 is not below k1");
    if (value[SURFACE_ENERGY] > 0 && value[K_ADH] > 0)
      throw calx::ConfigError(
          "surface_energy and k_adh are both given; adhesion follows from one of them, leave the other at 0");
    double inverse_e = 0, inverse_g = 0;
    for (const double* m : {material_i, material_j}) {
      inverse_e += (1 - m[POISSON] * m[POISSON]) / m[YOUNG];
      inverse_g += 2 * (2 - m[POISSON]) * (1 + m[POISSON]) / m[YOUNG];
    }
    const double n = hertz_ ? 1.5 : 1;
    // k1 = 4/3 E* sqrt(R*) for Hertz, 2 E* R* for exponent 1; the factor of the radius is the law's.
    row.k1_given = value[K1];
    row.k1_size = value[K1] > 0 ? 0 : (hertz_ ? 4.0 / 3.0 : 2.0) / inverse_e;
    row.unload = 1 / (1 - lambda);
    row.lambda = lambda;
    row.lambda_root = std::pow(lambda, 1 / n);
    row.adhesion = 1.5 * pi * value[SURFACE_ENERGY];
    row.k_adh_given = value[K_ADH];
    // At the cap the formula gives delta_min^n = delta_p^n / 2; LIGGGHTS sets delta_min = delta_p / 2 there.
    row.cap_share = literal_cap_ ? std::pow(0.5, n) : 0.5;
    row.cap_root = literal_cap_ ? 0.5 : std::pow(0.5, 1 / n);
    row.pull_off = value[PULL_OFF];
    row.retrace = retrace_ ? 1 : 0;
    row.chi_half = chi2_ & 1 ? 1 : 0;
    row.chi_1 = chi2_ & 2 ? 1 : 0;
    row.chi_2 = chi2_ & 4 ? 1 : 0;
    row.chi_4 = chi2_ & 8 ? 1 : 0;
    // c = 2 sqrt(5/6) zeta sqrt(S m*) with S = 3/2 k1 sqrt(delta), that is sqrt(5) zeta sqrt(k1 sqrt(delta) m*);
    // c = 2 zeta sqrt(k1 m*) for exponent 1 and, as a number, for literal_k1.
    const double log_e = std::log(value[RESTITUTION]);
    const double zeta = value[RESTITUTION] > 0 ? -log_e / std::sqrt(pi * pi + log_e * log_e) : 1;
    row.dash = (tsuji_ ? std::sqrt(5.0) : 2) * zeta;
    row.dash_t = (tsuji_ ? 2 * std::sqrt(5.0 / 6.0) : 2) * zeta;
    row.tsuji = tsuji_ ? 1 : 0;
    row.dash_always = dashpot_ == 2 ? 1 : 0;
    row.clipped = dashpot_ == 1 ? 1 : 0;
    // 8 G* sqrt(R* delta) = 6 G*/E* times k1 sqrt(delta), so a given k1 scales both stiffnesses.
    row.kt_share = value[TANGENTIAL_RATIO] * (hertz_ ? 6 * inverse_e / inverse_g : 1);
    row.rescaled = rescaled_ ? 1 : 0;
    row.friction = value[FRICTION];
    CALX_ROLLING_DERIVE(rolling_, value + ROLLING_FIRST, row);
  }

  // 0.17 sqrt(m / K), K = n k2 delta^(n-1): the unloading line is stiffer than the virgin one by 1/(1 - lambda)
  // (O'Sullivan, Bray 2004, for the factor).
  template <int twice_n>
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) noexcept {
    epam_n1_pair_f64 row;
    std::memcpy(&row, pair, offsetof(epam_n1_pair_f64, calx_unused));
    const double secant = row.k1_given * (twice_n == 3 ? std::sqrt(overlap) : 1) +
                          row.k1_size * (twice_n == 3 ? std::sqrt(r_eff * overlap) : r_eff);
    return 0.17 * std::sqrt(m_eff / (secant * std::fmax(0.5 * twice_n * row.unload, row.kt_share)));
  }

  bool hertz_, literal_cap_, retrace_, tsuji_, rescaled_;
  int chi2_, dashpot_, rolling_;
  calx_field given_[sizeof given / sizeof *given];
  calx_contact_law table_;
};

const calx_descriptor Epam::descriptor = {
    sizeof(calx_descriptor),
    0,
    "calx.epam",
    CALX_CONTACT_LAW,
    "Elasto-plastic adhesion (EEPA)",
    "1.0.0",
    "Calx",
    "Apache-2.0",
    "Elasto-plastic adhesive spheres that remember their consolidation, with friction and rolling resistance.",
    nullptr,
    options,
    sizeof options / sizeof *options,
    0,
    nullptr};

}  // namespace

CALX_PLUGIN(Epam)
