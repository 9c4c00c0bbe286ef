// device_library.hpp: shared libraries of drivers and compilers, opened at run time so that the engine needs none of
// them.
#pragma once
#include <string>
#include <vector>

namespace calx {

/// One opened library, never closed: drivers do not survive it.
struct DeviceLibrary {
  void* handle = nullptr;
  std::string name;     // of the file that was opened
  std::string failure;  // why none was, one reason for each name tried
};

/// The first of the names that opens. variable: an environment variable that, where set, names the only one to try.
DeviceLibrary open_device_library(const char* variable, const std::vector<std::string>& names);
/// Null where the library has no such function.
void* library_function(const DeviceLibrary& library, const char* name);

}  // namespace calx
