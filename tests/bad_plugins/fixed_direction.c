/* Has a direction of its own that nobody can turn. */
#define BAD_ID "test.fixed-direction"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  uint32_t k;
  (void)self;
  for (k = 0; k < block->count; ++k) block->fz[k] -= block->mass[k];
}
#include "bad_plugin.h"
