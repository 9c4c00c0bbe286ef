// version.cpp: the numbers come from the build.
#include "base/version.hpp"

namespace calx {
const char* version() { return CALX_VERSION; }
}  // namespace calx
