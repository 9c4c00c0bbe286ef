// bench_row.hpp: the figures of one timed run in the order they were added, as a JSON line or as text.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace calx {

class BenchRow {
 public:
  void text(const std::string& key, const std::string& value);
  /// Six digits; null for a number that is not finite.
  void number(const std::string& key, double value);
  void count(const std::string& key, unsigned long long value);
  void numbers(const std::string& key, const std::vector<double>& values);

  std::string json() const;
  /// One key a line, indented.
  std::string lines() const;
  /// To stdout.
  void print(bool as_json) const;

 private:
  std::vector<std::pair<std::string, std::string>> cells_;  // key, JSON value
};

}  // namespace calx
