/* Gives its factory for every id. */
#define BAD_ID "test.answers-any-id"
#define BAD_ANY_ID
#include "bad_plugin.h"
