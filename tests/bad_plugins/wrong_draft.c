/* The table is of another draft. */
#define BAD_ID "test.wrong-draft"
#define BAD_DRAFT 7
#include "bad_plugin.h"
