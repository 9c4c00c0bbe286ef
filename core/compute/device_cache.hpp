// device_cache.hpp: the folder of compiled modules, by content, and of the logs of those that did not compile.
// A cache never ends a run: what cannot be read is compiled anew, what cannot be written is said once in the log.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace calx {

struct CompiledModule {
  std::string image;  // cubin or shared library
  std::string log;    // of the compiler
};

class DeviceCache {
 public:
  /// folder: as DeviceOptions::cache.
  explicit DeviceCache(const std::string& folder);
  const std::string& folder() const { return folder_; }

  /// Key of a module: everything its image depends on. Parts are kept apart, so that "ab","c" is not "a","bc".
  static std::string key(const std::vector<std::string>& parts);

  /// Nothing where there is no file or one that is damaged.
  std::optional<CompiledModule> load(const std::string& key) const;
  void store(const std::string& key, const CompiledModule& module);
  /// The file the log was kept in; empty where it could not be written.
  std::string keep_log(const std::string& label, const std::string& log);

 private:
  bool write(const std::string& name, const std::string& content);
  std::string folder_;  // empty: no cache
  bool warned_ = false;
};

}  // namespace calx
