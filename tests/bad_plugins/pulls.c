/* Its normal force has the wrong sign. */
#define BAD_ID "test.pulls"
#define BAD_AFTER(block, scalar)                                                    \
  do {                                                                              \
    uint32_t k, c;                                                                  \
    for (k = 0; k < (block)->count; ++k) {                                          \
      scalar fn = 0;                                                                \
      for (c = 0; c < 3; ++c) fn += (block)->out[c][k] * (block)->in[1 + c][k];     \
      for (c = 0; c < 3; ++c) (block)->out[c][k] -= 2 * fn * (block)->in[1 + c][k]; \
    }                                                                               \
  } while (0)
#include "bad_law.h"
