// contact_plasticity.cpp: calx.contact-plasticity, plastic unloading on top of a Hertzian base law. The physics is
// contact_plasticity.law.h; here the pair row is made from moduli and plasticity.
#define CALX_TERM contact_plasticity
#define CALX_TERM_TEXT "contact_plasticity.law.h"
#define CALX_TERM_BYTES "contact_plasticity.law.h.inc"
#define CALX_TERM_SHA256 "contact_plasticity.law.h.sha256.inc"
#include <calx/law_term.hpp>
#include <calx/law/rolling_native.h>
#include <cmath>
#include <limits>

namespace {

enum { YOUNG, POISSON };
const calx_field material[] = {{"young", "Pa", "Young's modulus", 1, 1e14, 1e7, CALX_FIELD_REQUIRED, 0},
                               {"poisson", "1", "Poisson's ratio", 0, 0.5, 0.25, CALX_FIELD_REQUIRED, 0}};
const calx_field given[] = {
    {"plasticity", "1", "share of the largest overlap^1.5 that stays after unloading", 0, 0.95, 0, 0, 0}};
enum { HERTZ, STIFFER };

class ContactPlasticity : public calx::LawTerm {
 public:
  ContactPlasticity(const calx_host* host, const calx_config& config) : LawTerm(host, config) {
    table_.material = material;
    table_.material_count = sizeof material / sizeof *material;
    table_.given = given;
    table_.given_count = sizeof given / sizeof *given;
    table_.derive = &derive;
    table_.stable_dt = &stable_dt;
  }

 private:
  static calx_status CALX_CALL derive(const calx_instance*, const calx_host*, const double* i, const double* j,
                                      const double* value, double* pair) noexcept {
    const double softness = (1 - i[POISSON] * i[POISSON]) / i[YOUNG] + (1 - j[POISSON] * j[POISSON]) / j[YOUNG];
    pair[HERTZ] = 4.0 / 3.0 / softness;
    pair[STIFFER] = value[0] / (1 - value[0]);
    return CALX_OK;
  }
  // The unloading tangent k2 1.5 sqrt(d); without plasticity the base law alone limits the step.
  static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) noexcept {
    if (!(pair[STIFFER] > 0)) return std::numeric_limits<double>::infinity();
    return calx_stable_step(m_eff, 1.5 * (1 + pair[STIFFER]) * pair[HERTZ] * std::sqrt(r_eff * overlap), 0);
  }
};

}  // namespace

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.contact-plasticity", "Plastic contacts", "1.0.0", "Calx", "Apache-2.0",
                   "Plastic unloading of the Edinburgh law on top of a Hertzian base law.");

CALX_PLUGIN(ContactPlasticity)
