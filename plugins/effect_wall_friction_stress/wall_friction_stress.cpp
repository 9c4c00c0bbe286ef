// wall_friction_stress.cpp: calx.wall-friction-stress, wall friction that is higher where the wall is lightly loaded.
// The physics is wall_friction_stress.law.h.
#define CALX_TERM wall_friction_stress
#define CALX_TERM_TEXT "wall_friction_stress.law.h"
#define CALX_TERM_BYTES "wall_friction_stress.law.h.inc"
#define CALX_TERM_SHA256 "wall_friction_stress.law.h.sha256.inc"
#include <calx/law_term.hpp>

const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("calx.wall-friction-stress", "Stress-dependent wall friction", "1.0.0", "Calx", "Apache-2.0",
                   "Wall friction that is higher where the wall is lightly loaded.");

CALX_PLUGIN(calx::LawTerm)
