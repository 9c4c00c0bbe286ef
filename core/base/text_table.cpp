#include "base/text_table.hpp"

#include <algorithm>

namespace calx {

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) {
      width.resize(std::max(width.size(), k + 1));
      width[k] = std::max(width[k], row[k].size());
    }
  std::string out;
  for (const auto& row : rows) {
    out += "  ";
    for (std::size_t k = 0; k < row.size(); ++k) {
      out += row[k];
      if (k + 1 < row.size()) out.append(width[k] - row[k].size() + 2, ' ');
    }
    out += "\n";
  }
  return out;
}

}  // namespace calx
