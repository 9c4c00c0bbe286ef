/* Ends the process in create, as a library that meets an error of its own does. */
#define BAD_ID "test.exits-in-create"
#define BAD_CREATE exit(0)
#include <stdlib.h>

#include "bad_plugin.h"
