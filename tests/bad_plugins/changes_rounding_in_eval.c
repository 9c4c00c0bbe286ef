/* Changes the rounding mode when it is used. */
#define BAD_ID "test.changes-rounding-in-eval"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
#include <fenv.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  (void)self, (void)block;
  fesetround(FE_UPWARD);
}
#include "bad_plugin.h"
