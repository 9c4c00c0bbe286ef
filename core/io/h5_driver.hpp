// h5_driver.hpp: the HDF5 virtual file driver that reads and writes through a StagedFile.
#pragma once
#include <cstdint>

namespace calx {

class StagedFile;

/// A file access property list (a hid_t) for a file that stands on `file`, which outlives it; negative on failure. No
/// file locks: they fail on some network file systems, and readers of a running job are welcome.
std::int64_t h5_access_through(StagedFile& file);

}  // namespace calx
