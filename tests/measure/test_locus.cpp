#include <doctest/doctest.h>

#include <cmath>

#include "measure/locus.hpp"

using namespace calx;

namespace {
const double degree = 3.14159265358979323846 / 180;
}

// By hand: x 1 2 3 4, y 2.1 2.9 4.2 4.8; means 2.5 and 3.5, Sxx 5, Sxy 4.7; slope 0.94, intercept 1.15; residuals .01
// -.13 .23
// -.11, squares sum to 0.0820; variance 0.0410; errors sqrt(.041/5) and sqrt(.041 (1/4 + 6.25/5)).
TEST_CASE("a line and its standard errors") {
  const Locus line = fit_locus({{1, 2.1}, {2, 2.9}, {3, 4.2}, {4, 4.8}});
  CHECK(line.points == 4);
  CHECK(line.slope == doctest::Approx(0.94));
  CHECK(line.intercept == doctest::Approx(1.15));
  CHECK(line.slope_error == doctest::Approx(0.0905539));
  CHECK(line.intercept_error == doctest::Approx(0.2479919));
  CHECK(line.angle() == doctest::Approx(std::atan(0.94)));
  CHECK(line.angle_error() == doctest::Approx(0.0905539 / (1 + 0.94 * 0.94)));
}

TEST_CASE("too few points give no line, two give one without errors") {
  CHECK(std::isnan(fit_locus({}).slope));
  CHECK(std::isnan(fit_locus({{1, 2}}).slope));
  CHECK(std::isnan(fit_locus({{1, 2}, {1, 3}}).slope));
  const Locus two = fit_locus({{1, 2}, {3, 3}});
  CHECK(two.slope == doctest::Approx(0.5));
  CHECK(two.intercept == doctest::Approx(1.5));
  CHECK(std::isnan(two.slope_error));
}

// phi 30 deg, c 1 kPa: strength 2 cos 30 / (1 - sin 30) = 2 sqrt(3) kPa.
// The circle about 6 kPa that touches the locus has the radius 6 / 2 + sqrt(3)/2 = 3.866025 kPa and touches it at
// 6 - r / 2 = 4.0669873 kPa. Its point at 7 kPa lies at sqrt(r^2 - 1) = 3.7344548 kPa.
TEST_CASE("stress circles of a cohesive powder against numbers worked out by hand") {
  Locus locus;
  locus.slope = std::tan(30 * degree);
  locus.intercept = 1000;
  const FlowProperties f = flow_properties(locus, {7000, 3734.45477});
  CHECK(f.strength == doctest::Approx(2000 * std::sqrt(3.0)));
  CHECK(f.sigma1 == doctest::Approx(9866.0254).epsilon(1e-6));
  CHECK(f.sigma3 == doctest::Approx(2133.9746).epsilon(1e-6));
  CHECK(f.ffc == doctest::Approx(9866.0254 / 3464.1016).epsilon(1e-6));
  CHECK(f.effective_angle == doctest::Approx(std::asin(3866.0254 / 6000)).epsilon(1e-6));
  CHECK(f.steady_angle == doctest::Approx(std::atan(3734.45477 / 7000)));
}

// Without cohesion and with pre-shear on the locus the circle touches there: centre sigma / cos^2, radius centre * sin.
TEST_CASE("a powder without cohesion has no strength, and one angle for all") {
  Locus locus;
  locus.slope = std::tan(35 * degree);
  locus.intercept = 0;
  const FlowProperties f = flow_properties(locus, {5000, 5000 * locus.slope});
  CHECK(f.strength == 0);
  CHECK(std::isnan(f.ffc));
  const double centre = 5000 / std::pow(std::cos(35 * degree), 2), radius = centre * std::sin(35 * degree);
  // Two roots fall together; of their distance the square root of rounding remains.
  CHECK(f.sigma1 == doctest::Approx(centre + radius).epsilon(1e-6));
  CHECK(f.effective_angle == doctest::Approx(35 * degree).epsilon(1e-6));
  CHECK(f.steady_angle == doctest::Approx(35 * degree));
}

TEST_CASE("a pre-shear point above the locus takes the circle that touches nearest to it") {
  Locus locus;
  locus.slope = std::tan(30 * degree);
  locus.intercept = 1000;
  const double c = 1000, s = 0.5, k = std::sqrt(0.75);
  const FlowProperties f = flow_properties(locus, {4000, 4000 * locus.slope + 1100});
  const double centre = (4000 + c * s * k) / (k * k), radius = centre * s + c * k;
  CHECK(f.sigma1 == doctest::Approx(centre + radius));
  CHECK(f.sigma3 == doctest::Approx(centre - radius));
}
