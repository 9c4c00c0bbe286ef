/* create reports success without an instance. */
#define BAD_ID "test.create-nothing"
#define BAD_CREATE return CALX_OK
#include "bad_plugin.h"
