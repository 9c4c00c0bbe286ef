// table.hpp: the numbers of a CSV file of series or of measured data.
#pragma once
#include <string>
#include <vector>

namespace calx {

/// A table of numbers with a header row. Rows keep the line they stand on, for messages.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  // one number per column; NaN where a cell is empty or says nan
  std::vector<std::size_t> lines;         // of the file, from 1
};

/// Comma-separated text; lines that start with # are comments. Throws Error(Fault::settings) with file and line for a
/// cell that is no number, a row of another length, a column name that stands twice, no header, no rows.
Table parse_table(const std::string& text, const std::string& file);

}  // namespace calx
