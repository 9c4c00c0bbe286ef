#include "measure/flank.hpp"

#include <algorithm>
#include <cmath>

namespace calx {

Flank fit_flank(const std::vector<double>& heights, double d) {
  std::size_t end = 0;  // one past the last bin of the flank
  for (std::size_t k = 0; k < heights.size(); ++k) {
    if (!std::isnan(heights[k]))
      end = k + 1;
    else if (end > 0 && k >= end + 1)
      break;
  }
  std::size_t top = end;
  for (std::size_t k = 0; k < end; ++k)
    if (!std::isnan(heights[k]) && (top == end || heights[k] > heights[top])) top = k;
  if (top == end) return {};
  double base = heights[top];
  for (std::size_t k = top; k < end; ++k)
    if (heights[k] < base) base = heights[k];
  const double height = heights[top] - base;
  if (height < 5 * d) return {};
  std::size_t toe = top;
  while (!(heights[toe] <= base + d)) ++toe;

  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = top; k + 2 <= toe; ++k) {
    // In units of d from the apex; a bin counts by its middle.
    const double x = static_cast<double>(k) + 0.5, y = heights[k];
    if (x < 2 || !(y >= base + 0.2 * height && y <= base + 0.8 * height)) continue;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  if (n < 3) return {};
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx) / d;
  return {std::atan(-slope), static_cast<int>(n)};
}

double percentile(std::vector<double>& values, double fraction) {
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace calx
