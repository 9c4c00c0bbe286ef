/* Keeps something outside of the history of the contact. */
#define BAD_ID "test.remembers-outside"
static double earlier;
#define BAD_AFTER(block, scalar)                          \
  do {                                                    \
    (block)->out[0][0] += (scalar)(1e-3 * earlier);       \
    earlier = (double)(block)->in[0][(block)->count - 1]; \
  } while (0)
#include "bad_law.h"
