/* Goes on pulling beyond the reach it states. */
#define BAD_ID "test.too-short-a-reach"
#include <calx/all.h>
static double CALX_CALL reach(const double* pair, double r_i, double r_j) {
  (void)pair, (void)r_i, (void)r_j;
  return 1e-5;
}
#define BAD_REACH reach
#include "bad_law.h"
