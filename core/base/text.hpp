// text.hpp: small edits of text.
#pragma once
#include <string>

namespace calx {

/// text with every from, which is not empty, in it made to; what was put in is not looked at again.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace calx
