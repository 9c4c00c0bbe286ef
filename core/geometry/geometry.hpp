// geometry.hpp: the shape of one part in its own frame: triangles and surfaces of revolution with one closest-point
// rule.
//
// A point touches a face, an edge or a vertex only where that feature is a local minimum of the distance over the
// connected surface (its Voronoi region), so that each is found once. Minima whose normals differ by less than the
// crease angle are one contact, the nearest, so that a fine mesh of a smooth wall acts as one wall.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "calx/geometry.h"

namespace calx {

/// The nearest point of a surface to a sphere centre, part frame.
struct SurfacePoint {
  Vec3 point;           // m, on the surface
  Vec3 normal;          // unit, from the surface towards the centre
  double distance = 0;  // m, from the centre to point, >= 0
  std::uint32_t element = 0;
};

/// What is wrong with the triangles of a shape. Revolutions are smooth by construction and not examined.
struct MeshFaults {
  std::size_t open_edges = 0;    // edges of one triangle only
  std::size_t degenerate = 0;    // triangles without area; left out of the surface
  std::size_t duplicate = 0;     // triangles on the same three vertices as an earlier one; left out of the surface
  std::size_t inverted = 0;      // triangles wound against their neighbours, or whole closed shells turned inside out
  std::size_t non_manifold = 0;  // edges of three or more triangles
  // Middle of the first edge or triangle of each kind, m, part frame.
  Vec3 first_open, first_degenerate, first_duplicate, first_inverted, first_non_manifold;
  std::string describe() const;  // "3 open edges (first at (0.1, 0, 0.2) m), ..."; empty when none
};

namespace geometry {
struct Elements;
struct FlatTree;
}  // namespace geometry

/// Triangles for pictures and VTK; surfaces of revolution are cut within the chord given.
struct Tessellation {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> triangles;  // three vertex numbers each
};

class Surface {
 public:
  Surface();
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  /// Runs a geometry plugin's build() and indexes the result. Throws Error(Fault::plugin) with the plugin's message,
  /// Error(Fault::settings) for a shape without elements or with non-finite or degenerate elements.
  static Surface build(const calx_geometry& table, const calx_instance* instance, const calx_host* host,
                       const std::string& part_name);

  /// For tests and built-in shapes: add elements, then finish().
  void add_triangles(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& index);
  void add_revolution(const Vec3& origin, const Vec3& axis, const std::vector<double>& r_z, bool closed);
  void finish();

  Box bounds() const;
  std::size_t element_count() const;
  MeshFaults faults() const;

  /// Appends, ascending, the elements whose distance to p may be at most reach, m. [worker]
  void gather(const Vec3& p, double reach, std::vector<std::uint32_t>& elements) const;

  /// Elements are numbered triangles first, then profile segments, each in the order given.
  /// Contacts of a sphere of the radius given with the candidate elements: the local minima nearer than radius, deepest
  /// first, at most max_count. Pure, no allocation. A centre exactly on the surface gives the face's own normal.
  /// [worker]
  std::size_t closest(const Vec3& p, double radius, const std::uint32_t* elements, std::size_t element_count,
                      SurfacePoint* out, std::size_t max_count) const;

  Tessellation tessellate(double chord) const;
  /// What closest() reads, for those who bring it to a device; see elements.hpp.
  const geometry::Elements& elements() const;
  /// What gather() walks through, for the same.
  geometry::FlatTree flat_tree() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace calx
