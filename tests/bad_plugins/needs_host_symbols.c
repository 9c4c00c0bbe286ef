/* Calls a function that it expects in the program. */
#define BAD_ID "test.needs-host-symbols"
#include <calx/particle_force.h>
void calx_internal_function(void);
#define BAD_INIT            \
  calx_internal_function(); \
  return CALX_OK
#include "bad_plugin.h"
