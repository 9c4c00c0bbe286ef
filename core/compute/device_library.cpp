#include "compute/device_library.hpp"

#include <dlfcn.h>

#include <cstdlib>

namespace calx {

DeviceLibrary open_device_library(const char* variable, const std::vector<std::string>& names) {
  const char* own = std::getenv(variable);
  const std::vector<std::string> tried = own && *own ? std::vector<std::string>{own} : names;
  DeviceLibrary library;
  for (const std::string& name : tried) {
    library.handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    library.name = name;
    if (library.handle) return library;
    const char* reason = dlerror();
    library.failure += (library.failure.empty() ? "" : "; ") + std::string(reason ? reason : name.c_str());
  }
  return library;
}

void* library_function(const DeviceLibrary& library, const char* name) { return dlsym(library.handle, name); }

}  // namespace calx
