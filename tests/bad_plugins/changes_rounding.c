/* Changes the rounding mode when it is loaded. */
#define BAD_ID "test.changes-rounding"
#include <fenv.h>
__attribute__((constructor)) static void change(void) { fesetround(FE_UPWARD); }
#include "bad_plugin.h"
