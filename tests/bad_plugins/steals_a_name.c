/* Calls itself by the id of a plugin of Calx. */
#define BAD_ID "calx.stokes-drag"
#include "bad_plugin.h"
