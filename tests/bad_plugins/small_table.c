/* The table is smaller than that of ABI 1.0. */
#define BAD_ID "test.small-table"
#define BAD_TABLE_SIZE 8
#include "bad_plugin.h"
