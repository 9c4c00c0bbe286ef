// refused.hpp: why a plugin cannot be used, on its way from the check that found it to the registry, which adds where
// the case names the plugin. For core/plugin and core/conformance.
#pragma once
#include <string>

namespace calx {

struct Refused {
  std::string reason;
};

/// "case.json /contacts/0: ", or nothing where the call comes from no case.
inline std::string place(const std::string& file, const std::string& pointer) {
  if (file.empty() && pointer.empty()) return "";
  return file + (file.empty() || pointer.empty() ? "" : " ") + pointer + ": ";
}

}  // namespace calx
