/* Forgets everything at the first deinit, though calls nest. */
#define BAD_ID "test.counts-wrong"
#include <calx/particle_force.h>
static int is_ready;
#define BAD_INIT \
  is_ready = 1;  \
  return CALX_OK
#define BAD_DEINIT is_ready = 0
#define BAD_CREATE                                                                              \
  if (!is_ready) return host->fail(host, CALX_E_INTERNAL, "created before it was initialised"); \
  *out = &the_instance;                                                                         \
  return CALX_OK
#include "bad_plugin.h"
