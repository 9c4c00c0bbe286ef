// closest.cpp: contacts of one sphere with candidate elements, called every step for every sphere near a wall.
//
// A feature is a contact where it is a local minimum of the distance: a face where the centre projects into it; an edge
// or vertex where no element meeting there comes nearer in first order (Voronoi regions, Lin & Canny 1991). All
// conditions are met with a tolerance, so that rounding never leaves a hole between the regions; what is then found
// twice lies at the same point and is kept once, the face before the edge before the vertex.
#include <algorithm>
#include <type_traits>

#include "geometry/surface_impl.hpp"

namespace calx {
namespace {

using namespace geometry;

struct Found {
  SurfacePoint at;
  int rank;  // 0 face, 1 edge, 2 vertex
};

bool before(const Found& a, const Found& b) {
  if (a.at.distance != b.at.distance) return a.at.distance < b.at.distance;
  if (a.rank != b.rank) return a.rank < b.rank;
  return a.at.element < b.at.element;
}

/// The nearest minima found so far, without two at one point.
class Minima {
 public:
  static_assert(std::is_trivially_copyable_v<Found>);
  Minima(double tolerance, double crease_cosine) : same2_(16 * tolerance * tolerance), cosine_(crease_cosine) {}

  void add(const Found& f) {
    for (std::size_t k = 0; k < count_; ++k) {
      if (norm2(found_[k].at.point - f.at.point) > same2_) continue;
      if (before(f, found_[k])) found_[k] = f;
      return;
    }
    if (count_ == capacity) merge();
    if (count_ < capacity) {
      found_[count_++] = f;
      return;
    }
    const std::size_t last = static_cast<std::size_t>(std::max_element(found_, found_ + count_, before) - found_);
    if (before(f, found_[last])) found_[last] = f;
  }

  /// Deepest first; of those whose normals differ by less than the crease angle only the nearest stays.
  void merge() {
    if (count_ < 2) return;
    std::sort(found_, found_ + count_, before);
    std::size_t kept = 1;
    for (std::size_t k = 1; k < count_; ++k) {
      bool apart = true;
      for (std::size_t j = 0; j < kept && apart; ++j) apart = dot(found_[j].at.normal, found_[k].at.normal) < cosine_;
      if (apart) found_[kept++] = found_[k];
    }
    count_ = kept;
  }

  std::size_t give(SurfacePoint* out, std::size_t max_count) const {
    const std::size_t n = std::min(count_, max_count);
    for (std::size_t k = 0; k < n; ++k) out[k] = found_[k].at;
    return n;
  }

 private:
  static constexpr std::size_t capacity = 24;
  // Not initialised: nearly every call finds none or one, and clearing them all would be most of its work.
  union {
    Found found_[capacity];
  };
  std::size_t count_ = 0;
  double same2_, cosine_;
};

/// Unit direction of d, whose length is given; the fallback where the centre is on the feature to rounding.
Vec3 direction(const Vec3& d, double length, double tolerance, const Vec3& fallback) {
  return length > tolerance ? d / length : fallback;
}

void edge_minimum(const Elements& e, const Edge& edge, const Vec3& p, double radius, std::uint32_t element,
                  Minima& out) {
  const Vec3 q = p - edge.start;
  const double t = dot(q, edge.direction);
  if (t < -e.tolerance || t > edge.length + e.tolerance) return;
  const Vec3 d = q - t * edge.direction;
  const double d2 = norm2(d);
  if (d2 >= radius * radius) return;
  for (std::uint32_t k = 0; k < edge.count; ++k)
    if (dot(e.edge_inward[edge.first + k], q) > e.tolerance) return;
  const double length = std::sqrt(d2);
  out.add({{p - d, direction(d, length, e.tolerance, edge.normal), length, element}, 1});
}

void vertex_minimum(const Elements& e, const Vertex& v, const Vec3& p, double radius, std::uint32_t element,
                    Minima& out) {
  const Vec3 d = p - v.position;
  const double d2 = norm2(d);
  if (d2 >= radius * radius) return;
  for (std::uint32_t k = 0; k < v.count; ++k)
    if (dot(e.vertex_direction[v.first + k], d) > e.tolerance) return;
  const double length = std::sqrt(d2);
  out.add({{v.position, direction(d, length, e.tolerance, v.normal), length, element}, 2});
}

void triangle_minima(const Elements& e, std::uint32_t element, const Vec3& p, double radius, Minima& out) {
  const Triangle& t = e.triangles[element];
  const Vec3 q = p - t.corner[0];
  const double h = dot(t.normal, q);
  if (h >= radius || -h >= radius) return;
  const double s[3] = {dot(t.inward[0], q), dot(t.inward[1], p - t.corner[1]), dot(t.inward[2], q)};
  if (s[0] <= -radius || s[1] <= -radius || s[2] <= -radius) return;
  if (s[0] >= -e.tolerance && s[1] >= -e.tolerance && s[2] >= -e.tolerance) {
    // The side of a centre on the face to rounding is not known; the face's own normal is the rule.
    const Vec3 n = h < -e.tolerance ? -t.normal : t.normal;
    out.add({{p - h * t.normal, n, h < 0 ? -h : h, element}, 0});
    return;
  }
  for (int k = 0; k < 3; ++k)
    if (s[k] <= e.tolerance) edge_minimum(e, e.edges[t.edge[k]], p, radius, element, out);
  for (int k = 0; k < 3; ++k)
    if (s[k] <= e.tolerance || s[(k + 2) % 3] <= e.tolerance)
      vertex_minimum(e, e.vertices[t.vertex[k]], p, radius, element, out);
}

/// Back from the half plane to space.
Found in_space(const Axis& axis, const OnAxis& p, const Planar& at, const Planar& normal, double length,
               std::uint32_t element, int rank) {
  return {{axis.origin + at.r * p.radial + at.z * axis.direction, normal.r * p.radial + normal.z * axis.direction,
           length, element},
          rank};
}

/// The half-plane distance at the centre's own azimuth is the distance in space, since every profile point has r >= 0;
/// so local minima of the profile are those of the surface. A profile point on the axis meets its own mirror image,
/// whose condition is the weaker one.
void segment_minima(const Elements& e, std::uint32_t element, const OnAxis& p, double radius, Minima& out) {
  const Segment& s = e.segments[element - e.triangles.size()];
  const Axis& axis = e.axes[s.axis];
  const double qr = p.at.r - s.a.r, qz = p.at.z - s.a.z;
  const double h = s.normal.r * qr + s.normal.z * qz;
  if (h >= radius || -h >= radius) return;
  double t = s.along.r * qr + s.along.z * qz;
  if (t >= -e.tolerance && t <= s.length + e.tolerance) {
    t = std::min(std::max(t, 0.0), s.length);
    const Planar n = h < -e.tolerance ? Planar{-s.normal.r, -s.normal.z} : s.normal;
    out.add(in_space(axis, p, {s.a.r + t * s.along.r, s.a.z + t * s.along.z}, n, h < 0 ? -h : h, element, 0));
    return;
  }
  const ProfilePoint& point = e.points[s.point[t > 0 ? 1 : 0]];
  const double dr = p.at.r - point.position.r, dz = p.at.z - point.position.z;
  const double d2 = dr * dr + dz * dz;
  if (d2 >= radius * radius) return;
  for (std::uint32_t k = 0; k < point.count; ++k) {
    const Planar& along = e.point_direction[point.first + k];
    if (along.r * dr + along.z * dz > e.tolerance) return;
  }
  const double length = std::sqrt(d2);
  const Planar n = length > e.tolerance ? Planar{dr / length, dz / length} : point.normal;
  out.add(in_space(axis, p, point.position, n, length, element, 2));
}

}  // namespace

std::size_t Surface::closest(const Vec3& p, double radius, const std::uint32_t* elements, std::size_t element_count,
                             SurfacePoint* out, std::size_t max_count) const {
  const Elements& e = impl_->elements;
  Minima minima(e.tolerance, crease_cosine);
  OnAxis on_axis;
  std::uint32_t axis = static_cast<std::uint32_t>(-1);
  for (std::size_t k = 0; k < element_count; ++k) {
    const std::uint32_t element = elements[k];
    if (element < e.triangles.size()) {
      triangle_minima(e, element, p, radius, minima);
      continue;
    }
    const std::uint32_t own = e.segments[element - e.triangles.size()].axis;
    if (own != axis) on_axis = to_axis(e.axes[axis = own], p, e.size);
    segment_minima(e, element, on_axis, radius, minima);
  }
  minima.merge();
  return minima.give(out, max_count);
}

}  // namespace calx
