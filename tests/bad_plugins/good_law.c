/* Nothing wrong: the law the others are measured against. */
#define BAD_ID "test.good-law"

#include "bad_law.h"
