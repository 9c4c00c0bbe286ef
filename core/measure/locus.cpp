#include "measure/locus.hpp"

#include <cmath>
#include <limits>

namespace calx {

double Locus::angle() const { return std::atan(slope); }
double Locus::angle_error() const { return slope_error / (1 + slope * slope); }

Locus fit_locus(const std::vector<StressPoint>& points) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Locus out;
  out.points = static_cast<int>(points.size());
  out.slope = out.slope_error = out.intercept = out.intercept_error = nan;
  const double n = static_cast<double>(points.size());
  double sx = 0, sy = 0, xx = 0, xy = 0;
  for (const StressPoint& p : points) sx += p.normal, sy += p.shear;
  for (const StressPoint& p : points) {
    const double dx = p.normal - sx / n;
    xx += dx * dx, xy += dx * (p.shear - sy / n);
  }
  if (points.size() < 2 || !(xx > 0)) return out;
  out.slope = xy / xx;
  out.intercept = sy / n - out.slope * sx / n;
  if (points.size() < 3) return out;
  double residual = 0;
  for (const StressPoint& p : points) {
    const double r = p.shear - out.intercept - out.slope * p.normal;
    residual += r * r;
  }
  const double variance = residual / (n - 2);
  out.slope_error = std::sqrt(variance / xx);
  out.intercept_error = std::sqrt(variance * (1 / n + sx / n * sx / n / xx));
  return out;
}

// A circle about s with radius r touches shear = c + normal tan(phi) when r = s sin + c cos. With the point (p, q) on
// it, (p - s)^2 + q^2 = r^2, a quadratic in s: cos^2 s^2 - 2 (p + c sin cos) s + p^2 + q^2 - c^2 cos^2 = 0.
FlowProperties flow_properties(const Locus& locus, const StressPoint& pre_shear) {
  const double phi = locus.angle(), c = locus.intercept, p = pre_shear.normal, q = pre_shear.shear;
  const double sine = std::sin(phi), cosine = std::cos(phi);
  FlowProperties out;
  out.strength = 2 * c * cosine / (1 - sine);
  const double half = p + c * sine * cosine, square = cosine * cosine;
  const double root = half * half - square * (p * p + q * q - c * c * square);
  const double centre = (half - (root > 0 ? std::sqrt(root) : 0)) / square, radius = centre * sine + c * cosine;
  out.sigma1 = centre + radius;
  out.sigma3 = centre - radius;
  out.ffc = out.strength > 0 ? out.sigma1 / out.strength : std::numeric_limits<double>::quiet_NaN();
  out.effective_angle = std::asin(radius / centre);
  out.steady_angle = std::atan2(q, p);
  return out;
}

}  // namespace calx
