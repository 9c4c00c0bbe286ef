/* create reports an error. */
#define BAD_ID "test.create-fails"
#define BAD_CREATE return host->fail(host, CALX_E_MEMORY, "out of memory")
#include "bad_plugin.h"
