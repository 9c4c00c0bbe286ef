// wall_charge.cpp: calx.wall-charge, electrostatic pull of walls whose charge builds up or leaks away. The physics is
// wall_charge.law.h.
#define CALX_TERM wall_charge
#define CALX_TERM_TEXT "wall_charge.law.h"
#define CALX_TERM_BYTES "wall_charge.law.h.inc"
#define CALX_TERM_SHA256 "wall_charge.law.h.sha256.inc"
#include <calx/law_term.hpp>

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.wall-charge", "Electrostatic wall adhesion", "1.0.0", "Calx", "Apache-2.0",
                   "Electrostatic pull of walls whose charge builds up or leaks away.");

CALX_PLUGIN(calx::LawTerm)
