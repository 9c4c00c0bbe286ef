// table.hpp: reads the small CSV tables of tests/data.
#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

using Row = std::map<std::string, std::string>;

/// Rows of CALX_SOURCE_DIR/tests/data/<name>, cells by the header's names.
inline std::vector<Row> read_table(const std::string& name) {
  std::ifstream file(std::string(CALX_SOURCE_DIR "/tests/data/") + name);
  if (!file) throw std::runtime_error("cannot read tests/data/" + name);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out(1);
    for (const char c : line)
      if (c == ',')
        out.emplace_back();
      else if (c != '\r')
        out.back() += c;
    return out;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = cells(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = cells(line);
    if (values.size() != header.size()) continue;
    rows.emplace_back();
    for (std::size_t k = 0; k < header.size(); ++k) rows.back()[header[k]] = values[k];
  }
  return rows;
}
inline bool has(const Row& row, const std::string& name) { return !row.at(name).empty(); }
inline double number(const Row& row, const std::string& name) { return std::stod(row.at(name)); }

/// Lines of numbers of a report with headings, such as MFiX writes; other lines are left out.
inline std::vector<std::vector<double>> read_numbers(const std::string& name) {
  std::ifstream file(std::string(CALX_SOURCE_DIR "/tests/data/") + name);
  if (!file) throw std::runtime_error("cannot read tests/data/" + name);
  std::vector<std::vector<double>> rows;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream text(line);
    std::vector<double> row;
    for (double x; text >> x;) row.push_back(x);
    if (!row.empty() && text.eof()) rows.push_back(row);
  }
  return rows;
}

}  // namespace bench
