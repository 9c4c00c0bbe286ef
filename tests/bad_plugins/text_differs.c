/* Its native code is not that of its text: a little stiffer. */
#define BAD_ID "test.text-differs"
#define BAD_AFTER(block, scalar)                                              \
  do {                                                                        \
    uint32_t k;                                                               \
    for (k = 0; k < (block)->count; ++k) (block)->out[0][k] *= (scalar)1.001; \
  } while (0)
#include "bad_law.h"
