/* Changes the rounding mode in create. */
#define BAD_ID "test.changes-rounding-in-create"
#include <fenv.h>
#define BAD_CREATE         \
  fesetround(FE_DOWNWARD); \
  *out = &the_instance;    \
  return CALX_OK
#include "bad_plugin.h"
