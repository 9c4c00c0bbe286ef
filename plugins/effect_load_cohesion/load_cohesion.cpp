// load_cohesion.cpp: calx.load-cohesion, a pull in proportion to the largest force a contact has borne. The physics is
// load_cohesion.law.h.
#define CALX_TERM load_cohesion
#define CALX_TERM_TEXT "load_cohesion.law.h"
#define CALX_TERM_BYTES "load_cohesion.law.h.inc"
#define CALX_TERM_SHA256 "load_cohesion.law.h.sha256.inc"
#include <calx/law_term.hpp>

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.load-cohesion", "Load-dependent cohesion", "1.0.0", "Calx", "Apache-2.0",
                   "A pull in proportion to the largest force a contact has borne.");

CALX_PLUGIN(calx::LawTerm)
