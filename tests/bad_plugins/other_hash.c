/* Its text has another hash than it says. */
#define BAD_ID "test.other-hash"
#define BAD_SHA256 "0000000000000000000000000000000000000000000000000000000000000000"
#include "bad_law.h"
