/* Pushes harder while the spheres part than while they meet. */
#define BAD_ID "test.creates-energy"
#define BAD_AFTER(block, scalar)                                                          \
  do {                                                                                    \
    uint32_t k;                                                                           \
    for (k = 0; k < (block)->count; ++k)                                                  \
      if ((block)->in[4][k] * (block)->in[1][k] + (block)->in[5][k] * (block)->in[2][k] + \
              (block)->in[6][k] * (block)->in[3][k] >                                     \
          0) {                                                                            \
        (block)->out[0][k] *= (scalar)1.2;                                                \
        (block)->out[1][k] *= (scalar)1.2;                                                \
        (block)->out[2][k] *= (scalar)1.2;                                                \
      }                                                                                   \
  } while (0)
#include "bad_law.h"
