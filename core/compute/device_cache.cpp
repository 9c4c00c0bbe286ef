#include "compute/device_cache.hpp"

#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/log.hpp"
#include "base/sha256.hpp"

namespace calx {
namespace {

const std::string kMagic = "calx-module-1";
constexpr std::size_t kShaDigits = 64;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string preset_folder() {
  if (const std::string own = variable("CALX_CACHE"); !own.empty()) return own;
  if (const std::string base = variable("XDG_CACHE_HOME"); !base.empty()) return base + "/calx";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/calx";
  return "none";
}

}  // namespace

DeviceCache::DeviceCache(const std::string& folder) : folder_(folder.empty() ? preset_folder() : folder) {
  if (folder_ == "none") folder_.clear();
}

std::string DeviceCache::key(const std::vector<std::string>& parts) {
  Sha256 sum;
  for (const std::string& part : parts) {
    const std::string length = std::to_string(part.size()) + ":";
    sum.add(length.data(), length.size());
    sum.add(part.data(), part.size());
  }
  return sum.finish();
}

// File: magic, SHA-256 of the rest, one space between; then bytes of the image, a line end, image, log.
std::optional<CompiledModule> DeviceCache::load(const std::string& key) const {
  if (folder_.empty()) return {};
  const std::string path = folder_ + "/" + key + ".module";
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  const std::size_t head = kMagic.size() + 1 + kShaDigits + 1;
  const bool sound = all.size() > head && all.compare(0, kMagic.size(), kMagic) == 0 &&
                     all.compare(kMagic.size() + 1, kShaDigits, sha256(all.data() + head, all.size() - head)) == 0;
  if (!sound) {
    log_warning("the compiled module " + path + " is damaged; it is compiled anew");
    return {};
  }
  const std::size_t line = all.find('\n', head);
  const std::size_t bytes = std::stoull(all.substr(head, line - head));
  return CompiledModule{all.substr(line + 1, bytes), all.substr(line + 1 + bytes)};
}

void DeviceCache::store(const std::string& key, const CompiledModule& module) {
  const std::string body = std::to_string(module.image.size()) + "\n" + module.image + module.log;
  write(key + ".module", kMagic + " " + sha256(body) + " " + body);
}

std::string DeviceCache::keep_log(const std::string& label, const std::string& log) {
  std::string name;
  for (const char c : label) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  name = (name.empty() ? "module" : name) + ".log";
  return write(name, log) ? folder_ + "/" + name : "";
}

bool DeviceCache::write(const std::string& name, const std::string& content) {
  if (folder_.empty()) return false;
  // Other processes may write the same file now: each writes its own and renames it.
  static std::atomic<unsigned> count{0};
  const std::string path = folder_ + "/" + name;
  const std::string own = path + "." + std::to_string(getpid()) + "." + std::to_string(count++);
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (!failure) {
    errno = 0;
    std::ofstream file(own, std::ios::binary);
    file << content;
    file.close();
    if (!file) failure = std::error_code(errno ? errno : EIO, std::generic_category());
  }
  if (!failure) std::filesystem::rename(own, path, failure);
  if (!failure) return true;
  std::error_code ignored;
  std::filesystem::remove(own, ignored);
  if (!warned_)
    log_warning("compiled device modules are not kept: folder " + folder_ + ": " + failure.message() +
                "; the run goes on and compiles them each time. CALX_CACHE names another folder");
  warned_ = true;
  return false;
}

}  // namespace calx
