/* Works on whole groups of 16 rows, beyond the end of the block. */
#define BAD_ID "test.writes-past-the-block"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  uint32_t k;
  (void)self;
  for (k = 0; k < (block->count + 16) / 16 * 16; ++k) block->fx[k] += block->mass[k];
}
#include "bad_plugin.h"
