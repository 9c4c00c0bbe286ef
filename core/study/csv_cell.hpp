// csv_cell.hpp: text in a CSV file. Private to study/.
#pragma once
#include <string>

namespace calx {

/// In quotes, quotes doubled, without line ends (RFC 4180).
inline std::string csv_cell(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return out + "\"";
}

}  // namespace calx
