// overlap.cpp: volume of sphere and region in common: slices across the region's axis, in which the sphere is a disc
// and the region a rectangle (box) or a disc (cylinder, cone); both areas have closed forms.
#include "measure/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace calx {

namespace {

constexpr double pi = 3.14159265358979323846;

// Gauss-Legendre, 16 points on [-1, 1], positive half.
constexpr double node[8] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274, 0.6178762444026438,
                            0.7554044083550030, 0.8656312023878318, 0.9445750230732326, 0.9894009349916499};
constexpr double weight[8] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025, 0.1495959888165767,
                              0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541};

struct Point {
  double x, y;
};
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y; }

/// Signed area common to the disc of radius r at the origin and the triangle (origin, p, q).
double disc_triangle(const Point& p, const Point& q, double r) {
  const auto sector = [r](const Point& a, const Point& b) { return 0.5 * r * r * std::atan2(cross(a, b), dot(a, b)); };
  const Point d{q.x - p.x, q.y - p.y};
  const double a = dot(d, d), b = dot(p, d), c = dot(p, p) - r * r, discriminant = b * b - a * c;
  if (discriminant <= 0 || a <= 0) return sector(p, q);
  const double root = std::sqrt(discriminant), t1 = (-b - root) / a, t2 = (-b + root) / a;
  if (t2 <= 0 || t1 >= 1) return sector(p, q);
  const double enter = std::max(t1, 0.0), leave = std::min(t2, 1.0);
  const Point u{p.x + enter * d.x, p.y + enter * d.y}, v{p.x + leave * d.x, p.y + leave * d.y};
  return (t1 > 0 ? sector(p, u) : 0) + 0.5 * cross(u, v) + (t2 < 1 ? sector(v, q) : 0);
}

double disc_rectangle(double r, double x0, double x1, double y0, double y1) {
  const Point a{x0, y0}, b{x1, y0}, c{x1, y1}, d{x0, y1};
  return disc_triangle(a, b, r) + disc_triangle(b, c, r) + disc_triangle(c, d, r) + disc_triangle(d, a, r);
}

double disc_disc(double r1, double r2, double distance) {
  if (distance >= r1 + r2) return 0;
  if (distance <= std::abs(r1 - r2)) return pi * std::min(r1, r2) * std::min(r1, r2);
  const double d1 = (distance * distance + r1 * r1 - r2 * r2) / (2 * distance), d2 = distance - d1;
  const auto segment = [](double r, double d) {
    const double cosine = std::max(-1.0, std::min(1.0, d / r));
    return r * r * std::acos(cosine) - d * std::sqrt(std::max(0.0, r * r - d * d));
  };
  return segment(r1, d1) + segment(r2, d2);
}

double ball_ball(double r1, double r2, double distance) {
  if (distance >= r1 + r2) return 0;
  const double small = std::min(r1, r2);
  if (distance <= std::abs(r1 - r2)) return 4 * pi / 3 * small * small * small;
  const double gap = r1 + r2 - distance, difference = r1 - r2;
  return pi * gap * gap * (distance * distance + 2 * distance * (r1 + r2) - 3 * difference * difference) /
         (12 * distance);
}

/// Integral of area(s) over the ordered breaks. Areas grow as a power 3/2 or a root at a break; s = m - h cos(t) makes
/// the integrand smooth in t there.
template <class Area>
double integrate(std::vector<double> breaks, double lo, double hi, const Area& area) {
  breaks.push_back(lo);
  breaks.push_back(hi);
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double from = std::max(lo, breaks[k]), to = std::min(hi, breaks[k + 1]);
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    if (half <= 0) continue;
    for (int g = 0; g < 8; ++g)
      for (int side = -1; side <= 1; side += 2) {
        const double t = 0.5 * pi * (1 + side * node[g]);
        sum += 0.5 * pi * weight[g] * half * std::sin(t) * area(middle - half * std::cos(t));
      }
  }
  return sum;
}

double box_overlap(const Vec3& lo, const Vec3& hi, const Vec3& c, double radius) {
  const double x0 = lo.x - c.x, x1 = hi.x - c.x, y0 = lo.y - c.y, y1 = hi.y - c.y;
  const double from = std::max(lo.z - c.z, -radius), to = std::min(hi.z - c.z, radius);
  if (x0 >= radius || x1 <= -radius || y0 >= radius || y1 <= -radius || from >= to) return 0;
  std::vector<double> breaks;
  const auto add = [&](double squared) {
    if (squared >= radius * radius) return;
    const double s = std::sqrt(radius * radius - squared);
    breaks.insert(breaks.end(), {-s, s});
  };
  for (double x : {x0, x1}) {
    add(x * x);
    for (double y : {y0, y1}) add(x * x + y * y);
  }
  for (double y : {y0, y1}) add(y * y);
  return integrate(std::move(breaks), from, to, [&](double s) {
    const double squared = radius * radius - s * s;
    return squared > 0 ? disc_rectangle(std::sqrt(squared), x0, x1, y0, y1) : 0.0;
  });
}

/// Region of revolution about a to b, radius ra at a, rb at b.
double round_overlap(const RegionSettings& region, double ra, double rb, const Vec3& c, double radius) {
  const double length = norm(region.b - region.a);
  const Vec3 axis = (region.b - region.a) / length;
  const double s0 = calx::dot(c - region.a, axis), offset = norm(c - region.a - s0 * axis);
  const double from = std::max(0.0, s0 - radius), to = std::min(length, s0 + radius);
  if (from >= to || offset >= std::max(ra, rb) + radius) return 0;
  // The two discs touch where (ra + k s -+ offset)^2 + (s - s0)^2 = radius^2.
  const double k = (rb - ra) / length;
  std::vector<double> breaks;
  for (double side : {-1.0, 1.0}) {
    const double shift = ra + side * offset, qa = k * k + 1, qb = k * shift - s0;
    const double discriminant = qb * qb - qa * (shift * shift + s0 * s0 - radius * radius);
    if (discriminant <= 0) continue;
    const double root = std::sqrt(discriminant);
    breaks.insert(breaks.end(), {(-qb - root) / qa, (-qb + root) / qa});
  }
  return integrate(std::move(breaks), from, to, [&](double s) {
    const double squared = radius * radius - (s - s0) * (s - s0);
    return squared > 0 ? disc_disc(std::sqrt(squared), ra + k * s, offset) : 0.0;
  });
}

bool is_whole_in_box(const Vec3& lo, const Vec3& hi, const Vec3& c, double r) {
  for (int k = 0; k < 3; ++k)
    if (c[k] - r < lo[k] || c[k] + r > hi[k]) return false;
  return true;
}

}  // namespace

double overlap_volume(const RegionSettings& region, const Vec3& centre, double radius) {
  const double whole = 4 * pi / 3 * radius * radius * radius;
  switch (region.kind) {
    case RegionSettings::Kind::box:
      if (is_whole_in_box(region.a, region.b, centre, radius)) return whole;
      return box_overlap(region.a, region.b, centre, radius);
    case RegionSettings::Kind::sphere:
      return ball_ball(region.radius, radius, norm(centre - region.a));
    case RegionSettings::Kind::cylinder:
      return round_overlap(region, region.radius, region.radius, centre, radius);
    case RegionSettings::Kind::cone:
      return round_overlap(region, region.radius, region.radius_b, centre, radius);
  }
  return 0;
}

}  // namespace calx
