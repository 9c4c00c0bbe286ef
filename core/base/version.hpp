// version.hpp: what stands in provenance and behind --version.
#pragma once

namespace calx {
const char* version();       // "0.1.0"
const char* git_revision();  // short hash of the source, "+" when it had changes, "unknown" outside git
}  // namespace calx
