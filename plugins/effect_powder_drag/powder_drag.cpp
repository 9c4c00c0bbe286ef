// powder_drag.cpp: calx.powder-drag, drag of still air on the fine powder that a coarse grain stands for. The physics
// is powder_drag.law.h.
#define CALX_TERM powder_drag
#define CALX_TERM_TEXT "powder_drag.law.h"
#define CALX_TERM_BYTES "powder_drag.law.h.inc"
#define CALX_TERM_SHA256 "powder_drag.law.h.sha256.inc"
#include <calx/force_term.hpp>

const calx_descriptor calx::ForceTerm::descriptor =
    calx::force_term("calx.powder-drag", "Drag of the powder", "1.0.0", "Calx", "Apache-2.0",
                     "Drag of still air on the fine powder that a coarse grain stands for.");

CALX_PLUGIN(calx::ForceTerm)
