// text_table.hpp: rows of words in columns, for terminals.
#pragma once
#include <string>
#include <vector>

namespace calx {

/// Left-aligned columns two spaces apart, each row indented by two; the last cell of a row is not padded.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace calx
