/* Aborts when it is used. */
#define BAD_ID "test.aborts-in-eval"
#define BAD_OWN_EVAL
#include <calx/particle_force.h>
#include <stdlib.h>
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  (void)self, (void)block;
  abort();
}
#include "bad_plugin.h"
