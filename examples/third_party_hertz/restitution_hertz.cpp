// restitution_hertz.cpp: the law restitution_hertz.law.h as the plugin org.example.restitution-hertz.
#include <calx/plugin.hpp>
#include <cmath>
#include <cstring>

// The text is compiled in single and in double precision; CALX_LAW_BATCH makes a loop over contacts of it.
#define CALX_BITS 32
#include <calx/law/native.h>
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>

#include "restitution_hertz.law.h"
CALX_LAW_BATCH(restitution_hertz)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/native.h>
#include <calx/law/prelude.h>
#include <calx/law/sliding.h>

#include "restitution_hertz.law.h"
CALX_LAW_BATCH(restitution_hertz)
CALX_LAW_TABLES(restitution_hertz)

namespace {

const char source[] = {
#include "restitution_hertz.law.h.inc"
};
const char sha256[] =
#include "restitution_hertz.law.h.sha256.inc"
    ;

const calx_field material_fields[] = {{"young", "Pa", "Young's modulus", 1, 1e14, 1e7, 0, 0},
                                      {"poisson", "1", "Poisson's ratio", -0.99, 0.5, 0.25, 0, 0}};
const calx_field given_fields[] = {
    {"relaxation", "s", "dissipative time A of the pair; 0: no loss at any speed", 0, 1, 1e-5, 0, 0},
    {"friction", "1", "sliding friction", 0, 10, 0.5, 0, 0}};

class RestitutionHertz : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  RestitutionHertz(const calx_host*, const calx_config&) {
    std::memset(&table_, 0, sizeof table_);
    CALX_LAW_FILL(table_, restitution_hertz);
    table_.flags = CALX_LAW_EXACT;  // only + - * /, square root and comparisons: same bits on every device
    table_.material = material_fields;
    table_.material_count = 2;
    table_.given = given_fields;
    table_.given_count = 2;
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
  static calx_status CALX_CALL derive(const calx_instance*, const calx_host*, const double* mi, const double* mj,
                                      const double* given, double* pair) noexcept {
    pair[0] = 2 / ((1 - mi[1] * mi[1]) / mi[0] + (1 - mj[1] * mj[1]) / mj[0]);
    // 1 / G* = (2 - nu_i) / G_i + (2 - nu_j) / G_j with G = E / 2 (1 + nu).
    pair[1] = 8 / (2 * (2 - mi[1]) * (1 + mi[1]) / mi[0] + 2 * (2 - mj[1]) * (1 + mj[1]) / mj[0]);
    pair[2] = given[0];
    pair[3] = given[1];
    return CALX_OK;
  }

  // A tenth of the period of the mass on the stiffest spring it meets, 2 pi sqrt(m / k), shortened by the dashpot A k.
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) noexcept {
    const double a = std::sqrt(r_eff * overlap), k = std::fmax(pair[0], pair[1]) * a;
    const double period = std::sqrt(m_eff / k), damped = pair[2] > 0 ? m_eff / (pair[2] * k) : HUGE_VAL;
    return std::fmin(0.2 * 3.14159265358979324 * period, 0.2 * damped);
  }

  calx_contact_law table_;
};

const calx_descriptor RestitutionHertz::descriptor = {
    sizeof(calx_descriptor),
    0,
    "org.example.restitution-hertz",
    CALX_CONTACT_LAW,
    "restitution-hertz",
    "0.1.0",
    "Example",
    "MIT",
    "Hertz with a restitution that falls with speed (viscoelastic spheres), Mindlin, Coulomb.",
    nullptr,
    nullptr,
    0,
    0,
    nullptr};

}  // namespace

CALX_PLUGIN(RestitutionHertz)
