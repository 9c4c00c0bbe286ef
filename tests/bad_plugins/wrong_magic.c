/* The entry does not begin with the magic number. */
#define BAD_ID "test.wrong-magic"
#define BAD_MAGIC 0x12345678u
#include "bad_plugin.h"
