/* The table lacks its function. */
#define BAD_ID "test.null-eval"
#define BAD_OWN_EVAL
#define BAD_EVAL NULL
#include "bad_plugin.h"
