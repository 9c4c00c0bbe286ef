/* Built for the next major ABI. */
#define BAD_ID "test.other-major"
#define BAD_MAJOR 2
#include "bad_plugin.h"
