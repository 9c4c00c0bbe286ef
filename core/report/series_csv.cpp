#include "report/series_csv.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace calx {

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

SeriesTable parse_series(const std::string& text) {
  SeriesTable out;
  std::size_t at = 0;
  bool header = true;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos && !header) break;  // a row without its line end may lack digits
    const std::vector<std::string> cells =
        csv_cells(text.substr(at, end == std::string::npos ? std::string::npos : end - at));
    at = end == std::string::npos ? text.size() : end + 1;
    if (header) {
      out.columns.assign(cells.begin() + 1, cells.end());
      out.values.resize(out.columns.size());
      header = false;
      continue;
    }
    if (cells.size() != out.columns.size() + 1) continue;
    char* stop = nullptr;
    const double t = std::strtod(cells[0].c_str(), &stop);
    if (stop == cells[0].c_str() || !std::isfinite(t)) continue;
    out.time.push_back(t);
    for (std::size_t k = 0; k < out.columns.size(); ++k) {
      const double v = std::strtod(cells[k + 1].c_str(), &stop);
      out.values[k].push_back(stop == cells[k + 1].c_str() ? std::numeric_limits<double>::quiet_NaN() : v);
    }
  }
  return out;
}

}  // namespace calx
