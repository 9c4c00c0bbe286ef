#include "measure/flank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.hpp"

namespace calx {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double kLeastHeight = 5;  // diameters
constexpr double kLeastBins = 3;

/// Where a flank lies: [top, toe], the first bin within d of the lowest; found: it is high enough to have an angle.
struct Extent {
  bool found = false;
  std::size_t top = 0, toe = 0;
  double base = 0, height = 0;  // m, of the lowest bin; above it of the highest
};

Extent extent_of(const std::vector<double>& heights, double d) {
  std::size_t end = 0;  // one past the last bin of the flank
  for (std::size_t k = 0; k < heights.size(); ++k) {
    if (!std::isnan(heights[k]))
      end = k + 1;
    else if (end > 0 && k >= end + 1)
      break;
  }
  Extent e;
  e.top = end;
  for (std::size_t k = 0; k < end; ++k)
    if (!std::isnan(heights[k]) && (e.top == end || heights[k] > heights[e.top])) e.top = k;
  if (e.top == end) return e;
  e.base = heights[e.top];
  for (std::size_t k = e.top; k < end; ++k)
    if (heights[k] < e.base) e.base = heights[k];
  e.height = heights[e.top] - e.base;
  if (e.height < kLeastHeight * d) return e;
  e.found = true;
  e.toe = e.top;
  while (!(heights[e.toe] <= e.base + d)) ++e.toe;
  return e;
}

}  // namespace

Flank fit_flank(const std::vector<double>& heights, double d) {
  const Extent e = extent_of(heights, d);
  if (!e.found) return {};
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  Flank flank;
  for (std::size_t k = e.top; k + 2 <= e.toe; ++k) {
    // In units of d from the apex; a bin counts by its middle.
    const double x = static_cast<double>(k) + 0.5, y = heights[k];
    if (x < 2 || !(y >= e.base + 0.2 * e.height && y <= e.base + 0.8 * e.height)) continue;
    if (n < 1) flank.from = x * d;
    flank.to = x * d;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  if (n < kLeastBins) return {};
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx) / d;
  flank.angle = std::atan(-slope);
  flank.bins = static_cast<int>(n);
  flank.level = sy / n - slope * d * sx / n;
  return flank;
}

std::string no_flank(const std::vector<double>& heights, double d) {
  if (fit_flank(heights, d).bins > 0) return "";
  const Extent e = extent_of(heights, d);
  if (!e.found)
    return "the pile rises " + brief_quantity(e.height / d, "1") + " grain diameters over its lowest place; " +
           format_number(kLeastHeight) + " are needed";
  return "fewer than " + format_number(kLeastBins) +
         " bins of one grain diameter lie between 20 and 80 % of the flank's height";
}

double volume_angle(const std::vector<double>& heights, double d, bool is_wedge, double& base) {
  base = std::numeric_limits<double>::quiet_NaN();
  const Extent e = extent_of(heights, d);
  if (!e.found || e.toe == 0 || std::isnan(heights[e.toe - 1])) return base;
  const double plane = e.base + d, above = heights[e.toe - 1] - plane, below = plane - heights[e.toe];
  base = (static_cast<double>(e.toe) - 0.5 + above / (above + below)) * d;
  double volume = 0;
  for (std::size_t k = 0; k <= e.toe; ++k) {
    const double inner = static_cast<double>(k) * d, outer = std::min(inner + d, base);
    if (std::isnan(heights[k]) || outer <= inner) continue;
    volume += (heights[k] - plane) * (is_wedge ? outer - inner : pi * (outer * outer - inner * inner));
  }
  return std::atan(is_wedge ? 2 * volume / (base * base) : 3 * volume / (pi * base * base * base));
}

double percentile(std::vector<double>& values, double fraction) {
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace calx
