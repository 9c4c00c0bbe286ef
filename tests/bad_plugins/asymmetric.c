/* Pulls towards the particle that happens to be i. */
#define BAD_ID "test.asymmetric"
#define BAD_AFTER(block, scalar)                                                                     \
  do {                                                                                               \
    uint32_t k;                                                                                      \
    for (k = 0; k < (block)->count; ++k)                                                             \
      (block)->out[0][k] += (scalar)1e-3 * (block)->in[CALX_IN_R_I][k] * (block)->in[CALX_IN_NX][k]; \
  } while (0)
#include "bad_law.h"
