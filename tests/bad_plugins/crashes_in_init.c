/* Reads through a null pointer in init. */
#define BAD_ID "test.crashes-in-init"
#define BAD_INIT return *(volatile calx_status*)0
#include "bad_plugin.h"
