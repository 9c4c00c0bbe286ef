// rolling_resistance.cpp: calx.rolling-resistance, rolling resistance beside that of the base law, for grains less
// round than assumed. The physics is rolling_resistance.law.h.
#define CALX_TERM rolling_resistance
#define CALX_TERM_TEXT "rolling_resistance.law.h"
#define CALX_TERM_BYTES "rolling_resistance.law.h.inc"
#define CALX_TERM_SHA256 "rolling_resistance.law.h.sha256.inc"
#include <calx/law_term.hpp>

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.rolling-resistance", "Rolling resistance", "1.0.0", "Calx", "Apache-2.0",
                   "Rolling resistance beside that of the base law, for grains less round than assumed.");

CALX_PLUGIN(calx::LawTerm)
