// surface_impl.hpp: what a Surface holds. Private to core/geometry.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/elements.hpp"
#include "geometry/geometry.hpp"
#include "geometry/tree.hpp"

namespace calx {

/// cos 15 degrees: a mesh of a smooth wall with 24 or more facets a turn acts as one wall, a real corner does not.
constexpr double crease_cosine = 0.96592582628906829;

namespace geometry {

/// A revolution as added.
struct Profile {
  Vec3 origin, axis;
  std::vector<Planar> points;
  bool closed = false;
};

}  // namespace geometry

struct Surface::Impl {
  // As added; consumed by finish().
  std::vector<Vec3> raw_vertices;
  std::vector<std::array<std::uint32_t, 3>> raw_triangles;
  std::vector<geometry::Profile> raw_profiles;

  geometry::Elements elements;
  geometry::Tree tree;
  MeshFaults faults;
  Box bounds;
};

namespace geometry {

/// Welds, drops degenerate and duplicate triangles, links edges and vertices; counts faults. e.size must be set.
void index_triangles(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                     Elements& e, MeshFaults& faults);
/// Gathers profiles about the same line and links their segments. e.size must be set. Throws Error(Fault::settings).
void index_profiles(const std::vector<Profile>& profiles, Elements& e);

}  // namespace geometry
}  // namespace calx
