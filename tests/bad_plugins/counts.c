/* Counts init and deinit, as a plugin must; eval tells the count. */
#define BAD_ID "test.counts"
#include <calx/particle_force.h>
static int users;
#define BAD_INIT \
  ++users;       \
  return CALX_OK
#define BAD_DEINIT --users
#define BAD_OWN_EVAL
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  (void)self;
  block->fx[0] = users;
}
#include "bad_plugin.h"
