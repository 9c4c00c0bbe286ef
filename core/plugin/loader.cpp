#include "plugin/loader.hpp"

#define BOOST_DLL_USE_STD_FS  // header-only Boost.DLL
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/dll/shared_library.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "base/sha256.hpp"
#include "plugin/float_mode.hpp"
#include "plugin/refused.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
const char* const entry_symbol = "calx_plugin_entry";

/// What the process has loaded, kept to its end: instances of several simulations may share a library, and a plugin's
/// threads or exit handlers must not outlive its code. The descriptor stays open because glibc knows a library by the
/// name it was loaded under; were "/proc/self/fd/7" free again, the next library there would be taken for this one.
struct LoadedLibrary {
  unsigned long long device, inode;
  std::string sha256, path;
  int descriptor;
  std::unique_ptr<boost::dll::shared_library> handle;
  const calx_entry* entry;
  std::string refused;
};
struct LoadedLibraries {
  std::mutex mutex;
  std::vector<LoadedLibrary> list;
};
LoadedLibraries& loaded_libraries() {
  static LoadedLibraries* const libraries = new LoadedLibraries;  // outlives every static destructor
  return *libraries;
}

std::string hash_of(int descriptor, const std::string& path) {
  Sha256 hash;
  std::vector<char> buffer(1 << 16);
  for (off_t at = 0;;) {
    const ssize_t n = ::pread(descriptor, buffer.data(), buffer.size(), at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Refused{path + " cannot be read: " + std::strerror(errno)};
    if (n == 0) return hash.finish();
    hash.add(buffer.data(), static_cast<std::size_t>(n));
    at += n;
  }
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

}  // namespace

LibraryFile::LibraryFile(const std::string& path) : path_(path) {
  const fs::path given(path);
  std::error_code bad;
  // Without this, a bare name would be looked up in the working directory.
  if (!given.is_absolute() || fs::canonical(given.parent_path(), bad) != given.parent_path() || bad)
    throw Refused{path + " is not an absolute path without links"};

  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor_ < 0 && errno == ELOOP)
    throw Refused{path + " is a symbolic link; put the library itself beside its manifest"};
  if (descriptor_ < 0) throw Refused{path + " cannot be opened: " + std::strerror(errno)};
  try {
    struct stat info {};
    if (::fstat(descriptor_, &info) != 0) throw Refused{path + " cannot be examined: " + std::strerror(errno)};
    if (!S_ISREG(info.st_mode)) throw Refused{path + " is not a regular file"};
    if (info.st_uid != 0 && info.st_uid != ::geteuid())
      throw Refused{path + " belongs to user " + std::to_string(info.st_uid) +
                    "; only libraries owned by root or by the user who runs calx are loaded"};
    if (info.st_mode & S_IWOTH) throw Refused{path + " can be changed by every user; run chmod o-w on it"};
    device_ = info.st_dev;
    inode_ = info.st_ino;
    sha256_ = hash_of(descriptor_, path);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

LibraryFile::~LibraryFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string LibraryFile::content(std::size_t limit) const {
  std::string out(limit + 1, '\0');
  std::size_t at = 0;
  while (at < out.size()) {
    const ssize_t n = ::pread(descriptor_, &out[at], out.size() - at, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Refused{path_ + " cannot be read: " + std::strerror(errno)};
    if (n == 0) break;
    at += static_cast<std::size_t>(n);
  }
  if (at > limit) throw Refused{path_ + " is larger than " + std::to_string(limit) + " bytes"};
  out.resize(at);
  return out;
}

bool LibraryFile::is_known() const {
  LoadedLibraries& libraries = loaded_libraries();
  const std::lock_guard<std::mutex> lock(libraries.mutex);
  for (const LoadedLibrary& known : libraries.list)
    if (known.device == device_ && known.inode == inode_) return true;
  return false;
}

const calx_entry& LibraryFile::load() {
  LoadedLibraries& libraries = loaded_libraries();
  const std::lock_guard<std::mutex> lock(libraries.mutex);
  for (const LoadedLibrary& known : libraries.list) {
    if (known.device != device_ || known.inode != inode_) continue;
    if (known.sha256 != sha256_) throw Refused{path_ + " was changed after this process loaded it; start again"};
    if (!known.refused.empty()) throw Refused{known.refused};
    return *known.entry;
  }

  // Through the descriptor, so that what was checked and hashed is what is loaded.
  const std::string name = "/proc/self/fd/" + std::to_string(descriptor_);
  const FloatMode before = FloatMode::now();
  auto handle = std::make_unique<boost::dll::shared_library>();
  boost::dll::fs::error_code error;
  handle->load(name, error, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  const FloatMode after = FloatMode::now();
  if (after != before) before.restore();
  if (error) {
    const char* reason = ::dlerror();
    std::string text = reason ? reason : error.message();
    replace_all(text, name, path_);
    if (text.rfind(path_ + ": ", 0) == 0) text.erase(0, path_.size() + 2);
    throw Refused{path_ + " cannot be loaded: " + text};
  }

  LoadedLibrary library{device_, inode_, sha256_, path_, descriptor_, std::move(handle), nullptr, ""};
  descriptor_ = -1;
  if (after != before)
    library.refused = path_ + " changed the floating-point mode of the process when it was loaded (" + before.text() +
                      " became " + after.text() + "); rebuild it without -ffast-math and without fesetround";
  else if (!library.handle->has(entry_symbol))
    library.refused = path_ + " exports no " + entry_symbol + ", the one symbol of a Calx plugin";
  else
    library.entry = &library.handle->get<const calx_entry>(entry_symbol);
  libraries.list.push_back(std::move(library));
  const LoadedLibrary& kept = libraries.list.back();
  if (!kept.refused.empty()) throw Refused{kept.refused};
  return *kept.entry;
}

}  // namespace calx
