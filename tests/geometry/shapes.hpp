// shapes.hpp: what the geometry tests share: contacts by gather and closest, and surfaces made by plugins.
#pragma once
#include <string>
#include <vector>

#include "geometry/geometry.hpp"
#include "support/plugin_probe.hpp"

namespace calx {

inline std::vector<SurfacePoint> contacts(const Surface& s, const Vec3& p, double radius) {
  std::vector<std::uint32_t> near;
  s.gather(p, radius, near);
  SurfacePoint out[8];
  const std::size_t n = s.closest(p, radius, near.data(), near.size(), out, 8);
  return {out, out + n};
}

/// Distance from p to the nearest point of the surface, searched up to reach; reach when there is none.
inline double distance_to(const Surface& s, const Vec3& p, double reach) {
  const auto c = contacts(s, p, reach);
  return c.empty() ? reach : c[0].distance;
}

inline Surface build(PluginProbe& probe, const std::string& id, const ProbeValues& values,
                     const std::string& json = "{}") {
  const auto instance = probe.create(id, values, json);
  return Surface::build(instance->table<calx_geometry>(CALX_GEOMETRY), instance->get(), probe.host(), "tested part");
}

inline Surface mesh(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& index) {
  Surface s;
  s.add_triangles(vertices, index);
  s.finish();
  return s;
}

inline Surface revolution(const std::vector<double>& r_z, bool closed = false, const Vec3& origin = {},
                          const Vec3& axis = {0, 0, 1}) {
  Surface s;
  s.add_revolution(origin, axis, r_z, closed);
  s.finish();
  return s;
}

/// A rectangle [0, a] x [0, b] at z = 0 in n x n cells of two triangles, z up.
inline Surface flat(double a, double b, std::uint32_t n) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) v.push_back({a * i / n, b * j / n, 0});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t p = j * (n + 1) + i;
      t.insert(t.end(), {p, p + 1, p + n + 2, p, p + n + 2, p + n + 1});
    }
  return mesh(v, t);
}

/// The box [0, a]^3 with outward triangles.
inline Surface cube(double a) {
  std::vector<Vec3> v;
  for (int k = 0; k < 8; ++k) v.push_back({k & 1 ? a : 0, k & 2 ? a : 0, k & 4 ? a : 0});
  return mesh(
      v, {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6});
}

}  // namespace calx
