/* The table is smaller than the draft says. */
#define BAD_ID "test.small-table"
#define BAD_TABLE_SIZE 8
#include "bad_plugin.h"
