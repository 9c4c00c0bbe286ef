/* The table is of a draft. */
#define BAD_ID "test.wrong-draft"
#define BAD_DRAFT 7
#include "bad_plugin.h"
