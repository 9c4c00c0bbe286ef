/* create finds the user's case wrong. */
#define BAD_ID "test.create-rejects"
#define BAD_CREATE return host->fail(host, CALX_E_CONFIG, "gain = 3 is above 2; give at most 2")
#include "bad_plugin.h"
