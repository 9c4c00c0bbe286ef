// loader.hpp: from a path to the entry of a plugin library. The only place where foreign code enters the process.
// For core/plugin and core/conformance.
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
  /// The bytes of the opened file, for a law text. Throws Refused beyond limit bytes.
  std::string content(std::size_t limit) const;
  /// This process has loaded it before, so that it is known to come up.
  bool is_known() const;
  /// Loads it with immediate, local binding and returns its exported entry, which stays valid to the end of the
  /// process: nothing is unloaded. Throws Refused: cannot be loaded, no such symbol, changed the floating-point mode.
  const calx_entry& load();

 private:
  std::string path_, sha256_;
  int descriptor_ = -1;
  unsigned long long device_ = 0, inode_ = 0;
};

}  // namespace calx
