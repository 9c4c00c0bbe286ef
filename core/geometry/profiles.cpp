// profiles.cpp: surfaces of revolution as segments in half planes, linked where profiles about one line meet.
#include <algorithm>

#include "base/error.hpp"
#include "geometry/surface_impl.hpp"

namespace calx::geometry {
namespace {

/// Any unit vector across d, the same on every machine.
Vec3 across(const Vec3& d) {
  const Vec3 helper = std::abs(d.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(helper - dot(helper, d) * d);
}

/// The axis on which the profile lies; appended when it is new. Axes may be opposite.
std::uint32_t axis_of(const Profile& profile, Elements& e) {
  const Vec3 d = normalized(profile.axis);
  for (std::uint32_t k = 0; k < e.axes.size(); ++k) {
    const Axis& a = e.axes[k];
    const Vec3 offset = profile.origin - a.origin;
    if (norm(cross(a.direction, d)) <= weld_share && norm(cross(a.direction, offset)) <= weld_share * e.size) return k;
  }
  const Vec3 e1 = across(d);
  e.axes.push_back({profile.origin, d, e1, cross(d, e1)});
  return static_cast<std::uint32_t>(e.axes.size() - 1);
}

std::uint32_t point_number(Elements& e, std::uint32_t axis, Planar p) {
  const double tolerance = weld_share * e.size;
  if (p.r < tolerance) p.r = 0;
  for (std::uint32_t k = 0; k < e.points.size(); ++k) {
    const ProfilePoint& q = e.points[k];
    const double dr = q.position.r - p.r, dz = q.position.z - p.z;
    if (q.axis == axis && dr * dr + dz * dz <= tolerance * tolerance) return k;
  }
  ProfilePoint point;
  point.position = p;
  point.axis = axis;
  e.points.push_back(point);
  return static_cast<std::uint32_t>(e.points.size() - 1);
}

void add_segment(Elements& e, std::uint32_t axis, std::uint32_t a, std::uint32_t b) {
  if (a == b) throw Error(Fault::settings, "a surface of revolution has two equal neighbouring points");
  Segment s;
  s.axis = axis;
  s.point[0] = a, s.point[1] = b;
  s.a = e.points[a].position;
  const double dr = e.points[b].position.r - s.a.r, dz = e.points[b].position.z - s.a.z;
  s.length = std::sqrt(dr * dr + dz * dz);
  s.along = {dr / s.length, dz / s.length};
  s.normal = {s.along.z, -s.along.r};
  if (e.points[a].position.r == 0 && e.points[b].position.r == 0)
    throw Error(Fault::settings, "a surface of revolution has a piece that lies on its own axis");
  e.segments.push_back(s);
}

}  // namespace

void index_profiles(const std::vector<Profile>& profiles, Elements& e) {
  for (const Profile& profile : profiles) {
    const std::uint32_t axis = axis_of(profile, e);
    const Axis& line = e.axes[axis];
    const double base = dot(profile.origin - line.origin, line.direction);
    const bool same_way = dot(profile.axis, line.direction) > 0;
    std::vector<std::uint32_t> numbers;
    for (const Planar& p : profile.points)
      numbers.push_back(point_number(e, axis, {p.r, base + (same_way ? p.z : -p.z)}));
    if (profile.closed) numbers.push_back(numbers.front());
    // An opposite axis mirrors the half plane; running each piece backwards keeps its own normal where it was.
    for (std::size_t k = 1; k < numbers.size(); ++k)
      add_segment(e, axis, numbers[same_way ? k - 1 : k], numbers[same_way ? k : k - 1]);
  }
  std::vector<std::vector<Planar>> leaving(e.points.size());
  for (const Segment& s : e.segments) {
    leaving[s.point[0]].push_back(s.along);
    leaving[s.point[1]].push_back({-s.along.r, -s.along.z});
    for (const std::uint32_t p : s.point) e.points[p].normal.r += s.normal.r, e.points[p].normal.z += s.normal.z;
  }
  for (const Segment& s : e.segments)
    for (const std::uint32_t p : s.point) {
      Planar& n = e.points[p].normal;
      if (std::sqrt(n.r * n.r + n.z * n.z) < 1e-6) n = s.normal;
    }
  for (std::size_t k = 0; k < e.points.size(); ++k) {
    ProfilePoint& p = e.points[k];
    const double length = std::sqrt(p.normal.r * p.normal.r + p.normal.z * p.normal.z);
    p.normal = {p.normal.r / length, p.normal.z / length};
    p.first = static_cast<std::uint32_t>(e.point_direction.size());
    p.count = static_cast<std::uint32_t>(leaving[k].size());
    e.point_direction.insert(e.point_direction.end(), leaving[k].begin(), leaving[k].end());
  }
}

}  // namespace calx::geometry
