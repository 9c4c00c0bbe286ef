#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "measure/flank.hpp"

using namespace calx;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Bins of 2 mm down a straight flank of 40 degrees that starts 40 mm high.
std::vector<double> straight(std::size_t bins) {
  std::vector<double> heights;
  for (std::size_t k = 0; k < bins; ++k)
    heights.push_back(0.040 - std::tan(40 * degree) * 0.002 * (static_cast<double>(k) + 0.5));
  return heights;
}

}  // namespace

TEST_CASE("a straight flank gives its angle and the bins of its middle 60 %") {
  const Flank flank = fit_flank(straight(23), 0.002);
  CHECK(flank.angle / degree == doctest::Approx(40).epsilon(1e-12));
  CHECK(flank.bins == 13);  // of 22 bin widths in height
}

TEST_CASE("apex, toe and grains that lie apart do not enter the fit") {
  std::vector<double> heights = straight(23);
  heights[0] = heights[1] = heights[2];  // rounded apex
  heights[21] = heights[22] = 0.004;     // rounded toe
  for (double far : {none, none, 0.03, 0.03}) heights.push_back(far);
  const Flank flank = fit_flank(heights, 0.002);
  CHECK(flank.angle / degree == doctest::Approx(40).epsilon(1e-12));
  CHECK(flank.bins > 10);
}

TEST_CASE("scattered grains around a pile are not taken for its flank") {
  std::vector<double> heights = straight(23);
  for (int k = 0; k < 60; ++k) heights.push_back(0.002);
  CHECK(fit_flank(heights, 0.002).angle / degree == doctest::Approx(40).epsilon(1e-12));
}

TEST_CASE("single empty bins are stepped over") {
  std::vector<double> heights = straight(23);
  heights[0] = heights[9] = none;
  const Flank flank = fit_flank(heights, 0.002);
  CHECK(flank.angle / degree == doctest::Approx(40).epsilon(1e-12));
  CHECK(flank.bins == 11);  // 12 of 21 bin widths, less the empty one
}

TEST_CASE("too little pile has no angle") {
  CHECK(fit_flank({}, 0.002).bins == 0);
  CHECK(fit_flank({none, none}, 0.002).bins == 0);
  CHECK(fit_flank({0.002, 0.004, 0.002, 0.003}, 0.002).bins == 0);
  CHECK(fit_flank(straight(5), 0.002).bins == 0);  // 4 d high
  CHECK(fit_flank({0.03, 0.001, 0.001}, 0.002).bins == 0);
  std::vector<double> rising = straight(23);
  CHECK(fit_flank(std::vector<double>(rising.rbegin(), rising.rend()), 0.002).bins == 0);
}

TEST_CASE("the volume of a cone or wedge has the flank's angle, also on a lifted surface with grains around") {
  for (const bool is_wedge : {false, true}) {
    for (const double lift : {0.0, 0.0013}) {
      std::vector<double> heights = straight(23);
      for (double& h : heights) h += lift;
      for (int k = 0; k < 8; ++k) heights.push_back(heights[22]);
      double base = 0;
      const double angle = volume_angle(heights, 0.002, is_wedge, base);
      INFO("wedge ", is_wedge, " lift ", lift, " angle ", angle / degree, " base ", base);
      // The toe lies one bin above the lowest, whatever the lift. Bins take the height of their middle: in a cone of
      // radius r that loses (d / 2 r)^2 of the volume, 0.05 % here, 0.02 degrees.
      const double toe = (straight(23)[22] + 0.002 - 0.040) / -std::tan(40 * degree);
      CHECK(base == doctest::Approx(toe).epsilon(1e-9));
      CHECK(std::abs(angle / degree - 40) < 0.1);
    }
  }
}

TEST_CASE("a rounded apex lowers the angle of the volume, too little pile has none") {
  std::vector<double> heights = straight(23);
  for (int k = 0; k < 8; ++k) heights[static_cast<std::size_t>(k)] = heights[8];
  double base = 0;
  CHECK(volume_angle(heights, 0.002, false, base) / degree < 39);
  CHECK(std::isnan(volume_angle(straight(4), 0.002, false, base)));
  CHECK(std::isnan(base));
}

TEST_CASE("percentile interpolates between order statistics") {
  std::vector<double> values{5, 1, 3, 2, 4};
  CHECK(percentile(values, 0.5) == 3);
  CHECK(percentile(values, 0.95) == doctest::Approx(4.8));
  CHECK(percentile(values, 1) == 5);
  std::vector<double> one{7};
  CHECK(percentile(one, 0.95) == 7);
}
