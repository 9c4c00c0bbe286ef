// vent_pressure.cpp: calx.vent-pressure, upward pressure gradient in pulses, as air leaves a pocket that opens. The
// physics is vent_pressure.law.h.
#define CALX_TERM vent_pressure
#define CALX_TERM_TEXT "vent_pressure.law.h"
#define CALX_TERM_BYTES "vent_pressure.law.h.inc"
#define CALX_TERM_SHA256 "vent_pressure.law.h.sha256.inc"
#include <calx/force_term.hpp>

const calx_descriptor calx::ForceTerm::descriptor =
    calx::force_term("calx.vent-pressure", "Back-pressure of a venting pocket", "1.0.0", "Calx", "Apache-2.0",
                     "Upward pressure gradient in pulses, as air leaves a pocket that opens.");

CALX_PLUGIN(calx::ForceTerm)
