// version.cpp: the numbers come from the build.
#include "base/version.hpp"

#include "calx_git.hpp"

namespace calx {
const char* version() { return CALX_VERSION; }
const char* git_revision() { return CALX_GIT; }
}  // namespace calx
