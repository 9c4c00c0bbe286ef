/* The entry is smaller than that of release 1.0. */
#define BAD_ID "test.small-struct"
#define BAD_ENTRY_SIZE 24
#include "bad_plugin.h"
