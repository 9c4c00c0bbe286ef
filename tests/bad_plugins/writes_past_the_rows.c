/* A law that writes one row too many, beyond what a block is rounded up to. */
#define BAD_ID "test.writes-past-the-rows"
#define BAD_AFTER(block, scalar) (block)->out[2][((block)->count + 15) / 16 * 16] = (scalar)0
#include "bad_law.h"
