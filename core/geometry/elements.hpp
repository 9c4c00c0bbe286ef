// elements.hpp: what closest() reads, precomputed and contiguous: triangles with their edges and vertices, and profile
// segments of surfaces of revolution. For core/geometry, and for step/, which brings the tables to devices.
//
// An edge or vertex keeps one direction for each element that meets there, so that "local minimum over all elements
// sharing it" is decided from the feature alone, whichever of these elements are candidates.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"

namespace calx::geometry {

/// One triangle; edge k runs from corner k to corner k + 1.
struct Triangle {
  Vec3 corner[3];
  Vec3 normal;     // unit, counter-clockwise side
  Vec3 inward[3];  // unit, in the plane, from edge k towards the inside
  std::uint32_t edge[3], vertex[3];
};

struct Edge {
  Vec3 start, direction;  // direction unit
  double length = 0;
  Vec3 normal;                         // unit mean of the faces' normals, for a centre on the edge itself
  std::uint32_t first = 0, count = 0;  // its faces' inward vectors in Elements::edge_inward
};

struct Vertex {
  Vec3 position;
  Vec3 normal;                         // unit mean of the faces' normals
  std::uint32_t first = 0, count = 0;  // the edges leaving it in Elements::vertex_direction
};

/// A point of the half plane (distance from the axis, coordinate along it), m.
struct Planar {
  double r = 0, z = 0;
};

/// One axis; all revolutions about the same line share it.
struct Axis {
  Vec3 origin, direction, e1, e2;  // e1, e2, direction: right-handed, unit
};

/// One straight piece of a profile. Its own normal is to the right of a -> b in the (r, z) plane.
struct Segment {
  Planar a, along, normal;  // along, normal: unit
  double length = 0;
  std::uint32_t axis = 0, point[2] = {0, 0};
};

struct ProfilePoint {
  Planar position, normal;
  std::uint32_t axis = 0, first = 0, count = 0;  // the segments leaving it in Elements::point_direction
};

/// Element numbers: triangles first, then segments.
struct Elements {
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  std::vector<Vec3> edge_inward, vertex_direction;
  std::vector<Axis> axes;
  std::vector<Segment> segments;
  std::vector<ProfilePoint> points;
  std::vector<Planar> point_direction;
  double size = 0;       // m, diagonal of the bounding box
  double tolerance = 0;  // m, features closer together than this are one for the rule of local minima
  std::size_t count() const { return triangles.size() + segments.size(); }
};

/// A tree of boxes over the elements without pointers: parents before their children. After a box that is too far away
/// `skip` is the next to look at, after any other the one behind it.
struct FlatTree {
  struct Node {
    Box box;  // m
    std::uint32_t skip = 0;
    std::uint32_t first = 0, count = 0;  // of a leaf, in order; count 0: no leaf
    std::uint32_t unused = 0;
  };
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;  // elements
};

/// Rounding of a dot product of lengths up to the size is below 1e-14 of it; nearly degenerate triangles lose some
/// digits more. 1e-10 leaves room and is far below any overlap that matters.
constexpr double rounding_share = 1e-10;
/// Vertices closer than this share of the size are one: single-precision files round to 6e-8.
constexpr double weld_share = 2e-7;

/// Distance from p to one element, m.
double distance(const Elements& e, std::uint32_t element, const Vec3& p);
Box element_box(const Elements& e, std::uint32_t element);

/// The position of p in the half plane of an axis, and the unit radial direction there; e1 for a point on the axis.
struct OnAxis {
  Planar at;
  Vec3 radial;
};
inline OnAxis to_axis(const Axis& axis, const Vec3& p, double size) {
  const Vec3 q = p - axis.origin;
  const double z = dot(q, axis.direction);
  const Vec3 across = q - z * axis.direction;
  const double r = norm(across);
  // Below 1e-12 of the size the direction is only rounding; any fixed one serves.
  return {{r, z}, r > 1e-12 * size ? across / r : axis.e1};
}

}  // namespace calx::geometry
