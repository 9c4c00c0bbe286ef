// loader.hpp: from a path to the entry of a plugin library. The only place where foreign code enters the process.
// Private to core/plugin.
#pragma once
#include <string>

#include "calx/abi.h"

namespace calx {

/// A library opened, checked and hashed, but not yet loaded.
class LibraryFile {
 public:
  /// path: absolute and canonical. Opens once without following a link; a regular file, owned by root or by this user,
  /// not writable by everyone. The hash is of the opened file, and load() loads that same file. Throws Refused.
  explicit LibraryFile(const std::string& path);
  ~LibraryFile();
  LibraryFile(const LibraryFile&) = delete;
  LibraryFile& operator=(const LibraryFile&) = delete;

  const std::string& sha256() const { return sha256_; }
  /// Loads it with immediate, local binding and returns its exported entry, which stays valid to the end of the
  /// process: nothing is unloaded. Throws Refused: cannot be loaded, no such symbol, changed the floating-point mode.
  const calx_entry& load();

 private:
  std::string path_, sha256_;
  int descriptor_ = -1;
  unsigned long long device_ = 0, inode_ = 0;
};

}  // namespace calx
