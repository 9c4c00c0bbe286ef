// series_csv.hpp: CSV files read back, above all those of series/. A run of hours at 100 Hz gives some 1e6 rows.
#pragma once
#include <string>
#include <vector>

namespace calx {

struct SeriesTable {
  std::vector<std::string> columns;         // without the first, time_s
  std::vector<double> time;                 // s
  std::vector<std::vector<double>> values;  // one vector per column
};
/// Cells of one line, without quotes; a comma in quotes does not part cells.
std::vector<std::string> csv_cells(const std::string& line);

/// A last row cut short (the run is writing it) is left out; a cell that is no number becomes NaN.
SeriesTable parse_series(const std::string& text);

}  // namespace calx
