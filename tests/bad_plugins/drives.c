/* Its dashpot has the wrong sign: the force goes with the velocity. */
#define BAD_ID "test.drives"
#define BAD_AFTER(block, scalar)                                                               \
  do {                                                                                         \
    uint32_t k, c;                                                                             \
    for (k = 0; k < (block)->count; ++k) {                                                     \
      scalar vn = 0;                                                                           \
      for (c = 0; c < 3; ++c) vn += (block)->in[4 + c][k] * (block)->in[1 + c][k];             \
      for (c = 0; c < 3; ++c) (block)->out[c][k] += (scalar)0.02 * vn * (block)->in[1 + c][k]; \
    }                                                                                          \
  } while (0)
#include "bad_law.h"
