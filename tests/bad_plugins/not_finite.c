/* Gives a force that is not a number where a particle rests. */
#define BAD_ID "test.not-finite"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
#include <math.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  uint32_t k;
  (void)self;
  for (k = 0; k < block->count; ++k) block->fx[k] += block->vx[k] / fabs(block->vx[k]);
}
#include "bad_plugin.h"
