// Lets an exception leave create.
#include <calx/all.h>

#include <cstring>
#include <stdexcept>
#define BAD_ID "test.throws-across"
#define BAD_CREATE throw std::runtime_error("no such thing")
#include "bad_plugin.h"
