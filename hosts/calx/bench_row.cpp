#include "bench_row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "progress.hpp"

namespace calx {
namespace {

std::string six_digits(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

void BenchRow::text(const std::string& key, const std::string& value) { cells_.emplace_back(key, json_string(value)); }

void BenchRow::number(const std::string& key, double value) { cells_.emplace_back(key, six_digits(value)); }

void BenchRow::count(const std::string& key, unsigned long long value) {
  cells_.emplace_back(key, std::to_string(value));
}

void BenchRow::numbers(const std::string& key, const std::vector<double>& values) {
  std::string list;
  for (const double v : values) list += (list.empty() ? "" : ", ") + six_digits(v);
  cells_.emplace_back(key, "[" + list + "]");
}

std::string BenchRow::json() const {
  std::string out;
  for (const auto& cell : cells_) out += (out.empty() ? "{\"" : ", \"") + cell.first + "\": " + cell.second;
  return out + "}";
}

std::string BenchRow::lines() const {
  std::size_t width = 0;
  for (const auto& cell : cells_) width = std::max(width, cell.first.size());
  std::string out;
  for (const auto& cell : cells_)
    out += "  " + cell.first + std::string(width + 2 - cell.first.size(), ' ') + cell.second + "\n";
  return out;
}

void BenchRow::print(bool as_json) const {
  std::fputs(as_json ? (json() + "\n").c_str() : (lines() + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace calx
