// tessellate.cpp: triangles for pictures.
#include <algorithm>

#include "geometry/surface_impl.hpp"

namespace calx {
namespace {

using namespace geometry;

/// Facets a turn so that a chord leaves a circle of radius r by no more than the chord error.
int facet_count(double r, double chord) {
  const double share = std::min(std::max(chord / r, 1e-6), 0.5);
  return std::max(8, static_cast<int>(std::ceil(3.14159265358979324 / std::acos(1 - share))));
}

void ring(Tessellation& out, const Axis& axis, const Planar& p, int facets) {
  for (int k = 0; k < facets; ++k) {
    const double angle = 6.28318530717958648 * k / facets;
    out.vertices.push_back(axis.origin + p.z * axis.direction +
                           p.r * (std::cos(angle) * axis.e1 + std::sin(angle) * axis.e2));
  }
}

void add_segment(Tessellation& out, const Elements& e, const Segment& s, int facets) {
  const Planar a = e.points[s.point[0]].position, b = e.points[s.point[1]].position;
  const std::uint32_t base = static_cast<std::uint32_t>(out.vertices.size()), n = static_cast<std::uint32_t>(facets);
  ring(out, e.axes[s.axis], a, facets);
  ring(out, e.axes[s.axis], b, facets);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    const std::uint32_t a0 = base + k, a1 = base + next, b0 = base + n + k, b1 = base + n + next;
    if (a.r > 0) out.triangles.insert(out.triangles.end(), {a0, a1, b1});
    if (b.r > 0) out.triangles.insert(out.triangles.end(), {a0, b1, b0});
  }
}

}  // namespace

Tessellation Surface::tessellate(double chord) const {
  const Elements& e = impl_->elements;
  Tessellation out;
  for (const Vertex& v : e.vertices) out.vertices.push_back(v.position);
  for (const Triangle& t : e.triangles) out.triangles.insert(out.triangles.end(), t.vertex, t.vertex + 3);
  // One facet count for each axis, so that neighbouring rings fit.
  std::vector<int> facets(e.axes.size(), 8);
  for (const ProfilePoint& p : e.points)
    if (p.position.r > 0) facets[p.axis] = std::max(facets[p.axis], facet_count(p.position.r, chord));
  for (const Segment& s : e.segments) add_segment(out, e, s, facets[s.axis]);
  return out;
}

}  // namespace calx
