// statistics.hpp: the few statistics a report states.
#pragma once
#include <cstddef>
#include <vector>

namespace calx {

struct Spread {
  std::size_t count = 0;
  double mean = 0;
  double deviation = 0;  // sample standard deviation (n - 1); 0 for fewer than two values
};
/// Values that are not finite are left out.
Spread spread_of(const std::vector<double>& values);

/// y = intercept + slope x by least squares.
struct LinearFit {
  bool possible = false;  // needs two distinct x
  double slope = 0, intercept = 0;
  double r_squared = 1;  // share of the variance of y explained; 1 when y does not vary
};
LinearFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace calx
