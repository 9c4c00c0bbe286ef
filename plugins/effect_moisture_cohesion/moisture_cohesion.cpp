// moisture_cohesion.cpp: calx.moisture-cohesion, pull of liquid bridges that grows with time, as powder takes up
// moisture. The physics is moisture_cohesion.law.h.
#define CALX_TERM moisture_cohesion
#define CALX_TERM_TEXT "moisture_cohesion.law.h"
#define CALX_TERM_BYTES "moisture_cohesion.law.h.inc"
#define CALX_TERM_SHA256 "moisture_cohesion.law.h.sha256.inc"
#include <calx/law_term.hpp>

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.moisture-cohesion", "Moisture cohesion", "1.0.0", "Calx", "Apache-2.0",
                   "Pull of liquid bridges that grows with time, as powder takes up moisture.");

CALX_PLUGIN(calx::LawTerm)
