/* Needs an extension this host lacks, and its manifest does not say so. */
#define BAD_ID "test.needs-extension"
static const char* const required[] = {"calx.host.log/1", "calx.host.query/1", 0};
#define BAD_REQUIRED required
#include "bad_plugin.h"
