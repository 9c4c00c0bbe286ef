/* Nothing wrong: the plugin the others are measured against. */
#define BAD_ID "test.good"
#include "bad_plugin.h"
