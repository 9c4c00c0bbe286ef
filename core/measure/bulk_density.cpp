// bulk_density.cpp: kind "bulk-density": mass of solid per volume of "region".
//
// Columns: density_kg_m3, solid_fraction_1, mass_kg (of solid inside); what counts as inside says bulk_density.hpp. The
// region's whole volume counts, so keep walls and the free surface out of it.
#include "measure/bulk_density.hpp"

#include <cmath>

#include "measure/kinds.hpp"
#include "measure/overlap.hpp"

namespace calx {

namespace {

constexpr double whole_sphere = 4 * 3.14159265358979323846 / 3;

std::vector<Vec3> image_shifts(const DomainSettings& domain) {
  std::vector<Vec3> shifts{Vec3{}};
  for (int k = 0; k < 3; ++k) {
    if (!domain.periodic[static_cast<std::size_t>(k)]) continue;
    const std::size_t count = shifts.size();
    for (std::size_t s = 0; s < count; ++s)
      for (double side : {-1.0, 1.0}) {
        Vec3 shift = shifts[s];
        shift[k] += side * (domain.box.hi[k] - domain.box.lo[k]);
        shifts.push_back(shift);
      }
  }
  return shifts;
}

class BulkDensitySensor : public Sensor {
 public:
  explicit BulkDensitySensor(const RegionSettings& region) : region_(&region), volume_(region.volume()) {}
  std::vector<std::string> columns() const override { return {"density_kg_m3", "solid_fraction_1", "mass_kg"}; }
  std::vector<double> sample(const WorldView& world) override {
    const Solid solid = solid_in(world, region_);
    return {solid.mass / volume_, solid.volume / volume_, solid.mass};
  }

 private:
  RegionRef region_;
  double volume_;  // m^3
};

}  // namespace

Solid solid_in(const WorldView& world, const RegionRef& region) {
  const Particles& particles = world.particles();
  const Pose at = region.pose(world);
  const std::vector<Vec3> images = image_shifts(world.settings().domain);
  Solid solid;
  for (std::size_t p = 0; p < particles.count(); ++p) {
    const Shape& shape = particles.shapes[particles.shape[p]];
    const double scale = particles.scale[p];
    const std::size_t first = particles.has_clumps ? particles.first_sphere[p] : p;
    double cubes = 0;  // m^3, sum of r^3
    for (std::size_t m = 0; m < shape.members.size(); ++m) {
      const double r = particles.spheres()[first + m].r;
      cubes += r * r * r;
    }
    double inside = 0;  // m^3, of whole spheres
    for (std::size_t m = 0; m < shape.members.size(); ++m) {
      const Record& sphere = particles.spheres()[first + m];
      for (const Vec3& shift : images)
        inside += overlap_volume(region.settings(), at.to_part(position(sphere) + shift), sphere.r);
    }
    if (inside <= 0) continue;
    const double share = inside / (whole_sphere * cubes);
    solid.volume += share * shape.volume * scale * scale * scale;
    solid.mass += share * particles.body[p].m;
  }
  return solid;
}

std::unique_ptr<Sensor> make_bulk_density_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  if (!(region.volume() > 0)) throw options.error("region", "region \"" + region.name + "\" has no volume");
  return std::make_unique<BulkDensitySensor>(region);
}

}  // namespace calx
