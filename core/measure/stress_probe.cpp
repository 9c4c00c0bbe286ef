#include "measure/stress_probe.hpp"

#include <cmath>
#include <limits>

namespace calx {
namespace {

Vec3 direction(SensorOptions& options, const std::string& key, const Vec3& preset) {
  if (!options.has(key)) return preset;
  const Vec3 given = options.vector(key, "1");
  if (!(norm2(given) > 0)) throw options.error(key, "has no direction; give a vector of any length but 0");
  return normalized(given);
}

}  // namespace

StressProbe::StressProbe(SensorOptions& options)
    : area_(options.required_number("area", "m^2", 1e-12, 1e6)),
      normal_(direction(options, "normal", {0, 0, -1})),
      shear_(direction(options, "shear", {1, 0, 0})),
      below_(options.region("below")),
      has_below_(options.has("below")) {
  for (const PartSettings* part : options.parts("parts")) parts_.push_back(part->name);
  if (parts_.empty()) throw options.error("", "sensor \"" + options.settings().name + "\" needs \"parts\", a list");
  if (const PartSettings* slider = options.part("slider")) slider_ = slider->name;
  if (std::fabs(dot(normal_, shear_)) > 1e-6) throw options.error("shear", "must be at a right angle to \"normal\"");
}

StressState StressProbe::state(const WorldView& world) const {
  Vec3 force;
  for (const std::string& name : parts_) {
    const std::size_t part = part_number(world, name);
    if (world.part_present(part)) force += world.part_load(part).force;
  }
  StressState out;
  out.normal = (dot(force, normal_) - below_weight_) / area_;
  out.shear = dot(force, shear_) / area_;
  if (!slider_.empty()) out.speed = std::fabs(dot(world.part_pose(part_number(world, slider_)).velocity, shear_));
  return out;
}

void StressProbe::weigh(const WorldView& world) {
  if (!has_below_) return;
  double mass = 0;
  for (const Record& body : world.particles().body)
    if (below_.contains(world, position(body))) mass += body.m;
  below_weight_ = mass * dot(world.settings().gravity, normal_);
}

double StressProbe::inertial(const WorldView& world, double haste) {
  const Particles& particles = world.particles();
  if (particles.count() == 0) return std::numeric_limits<double>::quiet_NaN();
  return 0.1 * haste * std::sqrt(particles.density[particles.material[0]]);
}

}  // namespace calx
