#include "study/table.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "base/error.hpp"

namespace calx {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (c == at)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  std::size_t from = 0;
  while (from < text.size() && blank(text[from])) ++from;
  text = text.substr(from);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

}  // namespace

Table parse_table(const std::string& text, const std::string& file) {
  Table out;
  std::size_t number = 0;
  const auto refuse = [&](const std::string& what) {
    throw Error(Fault::settings, file + " line " + std::to_string(number) + ": " + what);
  };
  for (std::string line : split(text, '\n')) {
    ++number;
    if (number == 1 && line.compare(0, 3, "\xef\xbb\xbf") == 0) line = line.substr(3);
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    const std::vector<std::string> cells = split(line, ',');
    if (out.columns.empty()) {
      for (const std::string& c : cells) {
        const std::string name = trimmed(c);
        if (name.empty()) refuse("a column has no name");
        if (std::find(out.columns.begin(), out.columns.end(), name) != out.columns.end())
          refuse("column \"" + name + "\" stands twice");
        out.columns.push_back(name);
      }
      continue;
    }
    if (cells.size() != out.columns.size())
      refuse("holds " + std::to_string(cells.size()) + " values; the header names " +
             std::to_string(out.columns.size()) + " columns");
    std::vector<double> row;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::string cell = trimmed(cells[k]);
      char* end = nullptr;
      const double x = std::strtod(cell.c_str(), &end);
      if (!cell.empty() && (end == cell.c_str() || *end != '\0'))
        refuse("\"" + cell + "\" in column \"" + out.columns[k] + "\" is not a number");
      row.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN() : x);
    }
    out.rows.push_back(std::move(row));
    out.lines.push_back(number);
  }
  if (out.columns.empty())
    throw Error(Fault::settings, file + ": is empty; a header of column names and rows of numbers are needed");
  if (out.rows.empty()) throw Error(Fault::settings, file + ": holds a header but no rows of numbers");
  return out;
}

}  // namespace calx
