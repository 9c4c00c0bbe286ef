// column.hpp: columns of series and of measured data: the unit that ends their name, and the numbers of a CSV file.
#pragma once
#include <string>
#include <vector>

namespace calx {

/// The unit a column's name ends in, as units.hpp reads it: "mass_kg" -> "kg", "density_kg_m3" -> "kg/m^3",
/// "torque_x_N_m" -> "N m", "share_1" -> "1"; empty when it ends in none.
std::string column_unit(const std::string& column);

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
