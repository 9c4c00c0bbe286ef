// SPDX-License-Identifier: Apache-2.0
// linear.cpp: the plugin calx.linear. The law itself is linear.law.h; here are its tables, the
// numbers of a pair row from given values, and the choice of one of the two laws of the text.
#include <calx/plugin.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>

// The text is compiled once in single and once in double precision; native.h makes a loop over columns of each law.
#define CALX_BITS 32
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "linear.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(linear_spring)
CALX_LAW_BATCH(linear_spring_rolling)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>
#include <calx/law/rolling.h>
#include "linear.law.h"
#include <calx/law/native.h>
#include <calx/law/rolling_native.h>
CALX_LAW_BATCH(linear_spring)
CALX_LAW_BATCH(linear_spring_rolling)
CALX_LAW_TABLES(linear_spring)
CALX_LAW_TABLES(linear_spring_rolling)

namespace {

const char source[] = {
#include "linear.law.h.inc"
};
const char sha256[] =
#include "linear.law.h.sha256.inc"
    ;

// Options belong to the instance, given values to each pair; the case file holds both in one object.
const calx_field options[] = {CALX_ROLLING_OPTION{"tension", "allowed|clipped",
                                                  "allowed: the dashpot may pull at the end of a contact, restitution "
                                                  "is exact; clipped: the normal force never pulls",
                                                  0, 1, 0, CALX_FIELD_CHOICE, 0}};
enum { KN, KT, TANGENTIAL_RATIO, RESTITUTION, DAMPING, DAMPING_RATE, TANGENTIAL_DAMPING, FRICTION, ROLLING_FIRST };
const calx_field given[] = {
    {"kn", "N/m", "normal stiffness", 0, 1e15, 1e4, CALX_FIELD_REQUIRED, 0},
    {"kt", "N/m", "tangential stiffness; 0: tangential_ratio times kn", 0, 1e15, 0, 0, 0},
    {"tangential_ratio", "1", "tangential over normal stiffness, read where kt is 0", 0, 10, 2.0 / 7.0, 0, 0},
    {"restitution", "1", "speed after over speed before a head-on impact; 1: no dashpot from restitution", 0, 1, 0.5,
     CALX_FIELD_REQUIRED, 0},
    {"damping", "kg/s", "further normal dashpot, given outright", 0, 1e12, 0, 0, 0},
    {"damping_rate", "1/s", "further normal dashpot over the effective mass", 0, 1e12, 0, 0, 0},
    {"tangential_damping", "1", "factor on all tangential dashpots", 0, 10, 1, 0, 0},
    {"friction", "1", "sliding friction, tangential over normal force", 0, 10, 0.5, CALX_FIELD_REQUIRED, 0},
    CALX_ROLLING_GIVEN};

class Linear : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  Linear(const calx_host*, const calx_config& config)
      : rolling_(static_cast<int>(calx::parameter(descriptor, config, "rolling"))),
        clipped_(calx::parameter(descriptor, config, "tension") > 0.5) {
    std::memset(&table_, 0, sizeof table_);
    if (rolling_ == CALX_ROLLING_NONE)
      CALX_LAW_FILL(table_, linear_spring);
    else
      CALX_LAW_FILL(table_, linear_spring_rolling);
    table_.flags = CALX_LAW_EXACT;
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
  // A linear oscillator that ends at zero overlap returns e = exp(-pi zeta / sqrt(1 - zeta^2)), so
  // zeta = -ln e / sqrt(pi^2 + ln^2 e) and the dashpot is 2 zeta sqrt(k m*). The limit of zeta for e = 0 is 1.
  static calx_status CALX_CALL derive(const calx_instance* self, const calx_host* host, const double*, const double*,
                                      const double* value, double* pair) noexcept {
    return calx::guard(host, [&] {
      const Linear& law = *static_cast<const Linear*>(self);
      if (value[KN] <= 0) throw calx::ConfigError("kn is 0 N/m; a contact needs a positive normal stiffness");
      linear_spring_pair_f64 row;
      row.kn = value[KN];
      row.kt = value[KT] > 0 ? value[KT] : value[TANGENTIAL_RATIO] * value[KN];
      const double pi = 3.14159265358979323846;
      const double log_e = std::log(value[RESTITUTION]);
      const double zeta = value[RESTITUTION] > 0 ? -log_e / std::sqrt(pi * pi + log_e * log_e) : 1;
      const double share = value[TANGENTIAL_DAMPING];
      row.dash_n = 2 * zeta * std::sqrt(row.kn);
      row.dash_t = share * 2 * zeta * std::sqrt(row.kt);
      row.rate_n = value[DAMPING_RATE];
      row.rate_t = share * value[DAMPING_RATE];
      row.given_n = value[DAMPING];
      row.given_t = share * value[DAMPING];
      row.friction = value[FRICTION];
      row.lowest = law.clipped_ ? 0 : -1e30;
      CALX_ROLLING_DERIVE(law.rolling_, value + ROLLING_FIRST, row);
      std::memcpy(pair, &row, law.table_.pair_count * sizeof *pair);
    });
  }

  // 0.17 sqrt(m / K): stable for a sphere held by many springs of stiffness K (O'Sullivan, Bray 2004).
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double, double) noexcept {
    linear_spring_pair_f64 row;
    std::memcpy(&row, pair, offsetof(linear_spring_pair_f64, calx_unused));
    return 0.17 * std::sqrt(m_eff / std::max(row.kn, row.kt));
  }

  int rolling_;
  bool clipped_;
  calx_contact_law table_;
};

const calx_descriptor Linear::descriptor = {
    sizeof(calx_descriptor),
    0,
    "calx.linear",
    CALX_CONTACT_LAW,
    "Linear spring-dashpot",
    "1.0.0",
    "Calx",
    "Apache-2.0",
    "Linear spring and dashpot, tangential spring with history, Coulomb friction, rolling resistance.",
    nullptr,
    options,
    sizeof options / sizeof *options,
    0,
    nullptr};

}  // namespace

CALX_PLUGIN(Linear)
