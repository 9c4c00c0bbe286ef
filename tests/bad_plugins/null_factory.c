/* No factory. */
#define BAD_ID "test.null-factory"
#define BAD_FACTORY NULL
#include "bad_plugin.h"
