// saved_names.hpp: names of motions and events as one text of a checkpoint, a line each, and as messages show them.
#pragma once
#include <string>

namespace calx {

inline void append_name(std::string& lines, const std::string& name) { lines += name + "\n"; }

inline std::string listed(const std::string& lines) {
  std::string text;
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) text += lines[k] == '\n' ? ", " : std::string(1, lines[k]);
  return text;
}

}  // namespace calx
