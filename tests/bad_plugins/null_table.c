/* No table for its own kind. */
#define BAD_ID "test.null-table"
#define BAD_TABLE NULL
#include "bad_plugin.h"
