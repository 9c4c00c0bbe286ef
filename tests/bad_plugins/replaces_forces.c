/* Replaces the force of others instead of adding to it. */
#define BAD_ID "test.replaces-forces"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  uint32_t k;
  (void)self;
  for (k = 0; k < block->count; ++k) block->fx[k] = -block->mass[k] * block->vx[k];
}
#include "bad_plugin.h"
