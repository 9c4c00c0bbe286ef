#include "io/frame_columns.hpp"

#include <algorithm>
#include <cctype>

namespace calx {

FrameColumns frame_columns(const WorldView& world) {
  const Particles& p = world.particles();
  const std::size_t n = p.sphere_count();
  FrameColumns f;
  f.time = world.time();
  f.step = world.step();
  f.contacts = world.contact_counts();
  f.contacts.resize(n, 0);
  f.position.reserve(3 * n);
  f.velocity.reserve(3 * n);
  for (auto* column : {&f.sphere, &f.particle, &f.material}) column->reserve(n);
  f.radius.reserve(n);
  const Record* spheres = p.spheres();
  for (std::size_t i = 0; i < n; ++i) {
    const Record& s = spheres[i];
    const std::uint32_t owner = p.owner_of(i);
    for (const double c : {s.x, s.y, s.z}) f.position.push_back(c);
    for (const double c : {s.vx, s.vy, s.vz}) f.velocity.push_back(static_cast<float>(c));
    f.radius.push_back(static_cast<float>(s.r));
    f.sphere.push_back(p.sphere_id.size() == n ? p.sphere_id[i] : p.id[owner]);
    f.particle.push_back(p.id[owner]);
    f.material.push_back(p.material[owner]);
  }
  return f;
}

std::vector<PartShape> part_shapes(const WorldView& world) {
  const CaseSettings& settings = world.settings();
  std::vector<PartShape> out;
  for (std::size_t k = 0; k < world.part_count(); ++k) {
    PartShape shape;
    shape.name = world.part_name(k);
    const auto part = std::find_if(settings.parts.begin(), settings.parts.end(),
                                   [&](const PartSettings& s) { return s.name == shape.name; });
    if (part != settings.parts.end()) {
      shape.geometry = part->geometry;
      shape.material = part->material;
      const auto material = std::find_if(settings.materials.begin(), settings.materials.end(),
                                         [&](const MaterialSettings& m) { return m.name == shape.material; });
      if (material != settings.materials.end()) {
        shape.material_index = static_cast<std::uint32_t>(material - settings.materials.begin());
      }
    }
    const Surface& surface = world.part_surface(k);
    const Box box = surface.bounds();
    // A thousandth of the part's size: round at any zoom that shows the whole part, a few hundred triangles per ring.
    const Tessellation mesh = surface.tessellate(norm(box.hi - box.lo) / 1000);
    for (const Vec3& v : mesh.vertices) {
      for (int c = 0; c < 3; ++c) shape.vertices.push_back(static_cast<float>(v[c]));
    }
    shape.triangles = mesh.triangles;
    out.push_back(std::move(shape));
  }
  return out;
}

std::vector<std::string> safe_names(const std::vector<std::string>& names, const std::string& taken) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    std::string safe;
    for (const char c : name) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
      safe += plain ? c : '_';
    }
    if (safe.empty()) safe = "part";
    const auto used = [&](const std::string& s) {
      return s == taken || std::find(out.begin(), out.end(), s) != out.end();
    };
    std::string unique = safe;
    for (int k = 2; used(unique); ++k) unique = safe + "-" + std::to_string(k);
    out.push_back(unique);
  }
  return out;
}

}  // namespace calx
