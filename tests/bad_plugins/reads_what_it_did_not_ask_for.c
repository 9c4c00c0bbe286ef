/* Reads a column that its needs do not name, which is null. */
#define BAD_ID "test.reads-what-it-did-not-ask-for"
#define BAD_AFTER(block, scalar) (block)->out[0][0] += (block)->in[CALX_IN_M_EFF][0]
#include "bad_law.h"
