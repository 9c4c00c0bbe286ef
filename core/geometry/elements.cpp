#include "geometry/elements.hpp"

#include <algorithm>

namespace calx::geometry {
namespace {

double triangle_distance(const Triangle& t, const Vec3& p) {
  bool over_face = true;
  double best = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3 q = p - t.corner[k];
    if (dot(t.inward[k], q) >= 0) continue;
    over_face = false;
    const Vec3 side = t.corner[(k + 1) % 3] - t.corner[k];
    const double along = std::min(std::max(dot(q, side) / norm2(side), 0.0), 1.0);
    best = std::min(best, norm(q - along * side));
  }
  return over_face ? std::abs(dot(t.normal, p - t.corner[0])) : best;
}

double segment_distance(const Segment& s, const Planar& p) {
  const double qr = p.r - s.a.r, qz = p.z - s.a.z;
  const double along = std::min(std::max(qr * s.along.r + qz * s.along.z, 0.0), s.length);
  const double dr = qr - along * s.along.r, dz = qz - along * s.along.z;
  return std::sqrt(dr * dr + dz * dz);
}

}  // namespace

double distance(const Elements& e, std::uint32_t element, const Vec3& p) {
  if (element < e.triangles.size()) return triangle_distance(e.triangles[element], p);
  const Segment& s = e.segments[element - e.triangles.size()];
  return segment_distance(s, to_axis(e.axes[s.axis], p, e.size).at);
}

Box element_box(const Elements& e, std::uint32_t element) {
  Box box;
  if (element < e.triangles.size()) {
    for (const Vec3& p : e.triangles[element].corner) box.add(p);
    return box;
  }
  const Segment& s = e.segments[element - e.triangles.size()];
  const Axis& axis = e.axes[s.axis];
  const Vec3& d = axis.direction;
  for (const std::uint32_t k : s.point) {
    const Planar& p = e.points[k].position;
    const Vec3 centre = axis.origin + p.z * d;
    Vec3 half;
    for (int i = 0; i < 3; ++i) half[i] = p.r * std::sqrt(std::max(0.0, 1 - d[i] * d[i]));
    box.add(centre - half);
    box.add(centre + half);
  }
  return box;
}

}  // namespace calx::geometry
