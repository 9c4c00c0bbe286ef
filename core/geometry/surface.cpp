// surface.cpp: collecting a shape and making it ready for use.
#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "geometry/surface_impl.hpp"

namespace calx {
namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void refuse(const std::string& why) { throw Error(Fault::settings, why); }

}  // namespace

Surface::Surface() : impl_(new Impl) {}
Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

void Surface::add_triangles(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& index) {
  const std::uint32_t base = static_cast<std::uint32_t>(impl_->raw_vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (!finite(vertices[k])) refuse("vertex " + std::to_string(k) + " is not finite; coordinates are numbers in m");
  if (index.size() % 3 != 0)
    refuse("a triangle list has " + std::to_string(index.size()) +
           " vertex numbers; three for each triangle are needed");
  for (const std::uint32_t v : index)
    if (v >= vertices.size())
      refuse("a triangle names vertex " + std::to_string(v) + " of " + std::to_string(vertices.size()));
  impl_->raw_vertices.insert(impl_->raw_vertices.end(), vertices.begin(), vertices.end());
  for (std::size_t k = 0; k < index.size(); k += 3)
    impl_->raw_triangles.push_back({base + index[k], base + index[k + 1], base + index[k + 2]});
}

void Surface::add_revolution(const Vec3& origin, const Vec3& axis, const std::vector<double>& r_z, bool closed) {
  if (!finite(origin) || !finite(axis) || !(norm(axis) > 0))
    refuse("a surface of revolution needs a finite origin and an axis that is not zero");
  if (r_z.size() % 2 != 0 || r_z.size() < 4)
    refuse("a surface of revolution has " + std::to_string(r_z.size()) +
           " profile numbers; pairs (r, z) of at least two points are needed");
  geometry::Profile profile{origin, axis, {}, closed};
  for (std::size_t k = 0; k < r_z.size(); k += 2) {
    if (!std::isfinite(r_z[k]) || !std::isfinite(r_z[k + 1]) || r_z[k] < 0)
      refuse("profile point " + std::to_string(k / 2) + " of a surface of revolution must be finite with r >= 0");
    profile.points.push_back({r_z[k], r_z[k + 1]});
  }
  impl_->raw_profiles.push_back(std::move(profile));
}

void Surface::finish() {
  Impl& s = *impl_;
  if (s.raw_triangles.empty() && s.raw_profiles.empty())
    refuse("the shape has no triangle and no surface of revolution");
  // Lengths are compared with the size, so the size comes first, from what was added.
  Box raw;
  for (const auto& t : s.raw_triangles)
    for (const std::uint32_t v : t) raw.add(s.raw_vertices[v]);
  for (const geometry::Profile& p : s.raw_profiles) {
    const Vec3 d = normalized(p.axis);
    for (const geometry::Planar& q : p.points)
      for (int k = 0; k < 3; ++k) {
        Vec3 half;
        half[k] = q.r * std::sqrt(std::max(0.0, 1 - d[k] * d[k]));
        raw.add(p.origin + q.z * d - half);
        raw.add(p.origin + q.z * d + half);
      }
  }
  geometry::Elements& e = s.elements;
  e.size = norm(raw.hi - raw.lo);
  if (!(e.size > 0)) refuse("the shape has no extent: all its points are equal");
  // Far from the origin of its frame, coordinates themselves round more coarsely than the size would.
  const double far = std::max({std::abs(raw.lo.x), std::abs(raw.lo.y), std::abs(raw.lo.z), std::abs(raw.hi.x),
                               std::abs(raw.hi.y), std::abs(raw.hi.z)});
  e.tolerance = geometry::rounding_share * std::max(e.size, far);
  geometry::index_triangles(s.raw_vertices, s.raw_triangles, e, s.faults);
  geometry::index_profiles(s.raw_profiles, e);
  if (e.count() == 0) refuse("all triangles of the shape are degenerate: " + s.faults.describe());

  std::vector<Box> boxes;
  boxes.reserve(e.count());
  for (std::uint32_t k = 0; k < e.count(); ++k) boxes.push_back(geometry::element_box(e, k));
  for (const Box& b : boxes) s.bounds.add(b.lo), s.bounds.add(b.hi);
  s.tree.build(boxes);
  s.raw_vertices = {};
  s.raw_triangles = {};
  s.raw_profiles = {};
}

const geometry::Elements& Surface::elements() const { return impl_->elements; }
geometry::FlatTree Surface::flat_tree() const { return impl_->tree.flat(); }
Box Surface::bounds() const { return impl_->bounds; }
std::size_t Surface::element_count() const { return impl_->elements.count(); }
MeshFaults Surface::faults() const { return impl_->faults; }

void Surface::gather(const Vec3& p, double reach, std::vector<std::uint32_t>& elements) const {
  const geometry::Elements& e = impl_->elements;
  const double limit = reach + e.tolerance;
  const std::size_t old = elements.size();
  impl_->tree.near(p, limit, [&](std::uint32_t element) {
    if (geometry::distance(e, element, p) <= limit) elements.push_back(element);
  });
  std::sort(elements.begin() + static_cast<std::ptrdiff_t>(old), elements.end());
}

}  // namespace calx
