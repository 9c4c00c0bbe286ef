/* Prints when it is used. */
#define BAD_ID "test.prints"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
#include <stdio.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  (void)self;
  printf("working on %u particles\n", (unsigned)block->count);
}
#include "bad_plugin.h"
