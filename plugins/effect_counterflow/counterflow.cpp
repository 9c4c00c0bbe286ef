// counterflow.cpp: calx.counterflow, steady air upwards through a region, as it lifts the fine powder that a coarse
// grain stands for. The physics is counterflow.law.h.
#define CALX_TERM counterflow
#define CALX_TERM_TEXT "counterflow.law.h"
#define CALX_TERM_BYTES "counterflow.law.h.inc"
#define CALX_TERM_SHA256 "counterflow.law.h.sha256.inc"
#include <calx/force_term.hpp>

const calx_descriptor calx::ForceTerm::descriptor = calx::force_term(
    "calx.counterflow", "Counter-flow of air", "1.0.0", "Calx", "Apache-2.0",
    "Steady air upwards through a region, as it lifts the fine powder that a coarse grain stands for.");

CALX_PLUGIN(calx::ForceTerm)
