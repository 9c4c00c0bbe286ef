/* Never returns from an evaluation with a large overlap. */
#define BAD_ID "test.never-returns"
#define BAD_AFTER(block, scalar)             \
  while ((block)->in[0][0] > (scalar)8e-4) { \
    volatile int wait = 1;                   \
    (void)wait;                              \
  }
#include "bad_law.h"
