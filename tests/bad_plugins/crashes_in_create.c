/* Reads through a null pointer in create. */
#define BAD_ID "test.crashes-in-create"
#define BAD_CREATE return *(volatile calx_status*)0
#include "bad_plugin.h"
