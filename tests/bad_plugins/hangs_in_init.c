/* Never returns from init. */
#define BAD_ID "test.hangs-in-init"
#define BAD_INIT    \
  for (;;) pause(); \
  return CALX_OK
#include <unistd.h>

#include "bad_plugin.h"
