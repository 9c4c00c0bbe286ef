#include "report/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace calx {

Spread spread_of(const std::vector<double>& values) {
  Spread out;
  double sum = 0;
  for (double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v;
    ++out.count;
  }
  if (out.count == 0) return out;
  out.mean = sum / static_cast<double>(out.count);
  double squares = 0;
  for (double v : values) {
    if (std::isfinite(v)) squares += (v - out.mean) * (v - out.mean);
  }
  if (out.count > 1) out.deviation = std::sqrt(squares / static_cast<double>(out.count - 1));
  return out;
}

LinearFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  LinearFit out;
  const std::size_t count = std::min(x.size(), y.size());
  if (count < 2) return out;
  const double n = static_cast<double>(count);
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < count; ++i) mean_x += x[i] / n, mean_y += y[i] / n;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!(xx > 0)) return out;
  out.possible = true;
  out.slope = xy / xx;
  out.intercept = mean_y - out.slope * mean_x;
  if (yy > 0) out.r_squared = xy * xy / (xx * yy);
  return out;
}

}  // namespace calx
