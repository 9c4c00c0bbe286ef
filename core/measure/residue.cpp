// residue.cpp: kind "residue": what is left lying on a part or in a region that may move with a part.
//
// Give "part", "region" or both. A particle counts when
//   its centre of mass is in the region (if one is given), and
//   it rests on the part (if one is given): it touches the part from above, or touches from above a particle that rests
//   on it, through any number of particles; from above: the contact normal rises by more than 0.1, which leaves out
//   contacts with steep walls, and
//   its speed against the part, or against the part that the region follows, or against the world, is below "speed"
//   (0.01 m/s preset).
// Up is against gravity, +z without gravity. Columns: mass_kg, particles_1. A count of N particles carries a counting
// noise of about 1/sqrt(N) from run to run; it is not in a column, because one run cannot know its scatter.
#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

class ResidueSensor : public Sensor {
 public:
  ResidueSensor(const RegionSettings* region, std::string part, std::string carrier, double speed)
      : region_(region), part_(std::move(part)), carrier_(std::move(carrier)), speed_(speed) {}
  std::vector<std::string> columns() const override { return {"mass_kg", "particles_1"}; }

  std::vector<double> sample(const WorldView& world) override {
    const Particles& particles = world.particles();
    std::vector<std::uint8_t> resting(particles.count(), 1);
    if (!part_.empty()) resting = supported(world);
    const Pose carrier = carrier_.empty() ? Pose{} : world.part_pose(part_number(world, carrier_));
    double mass = 0, count = 0;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      const Record& body = particles.body[p];
      if (!resting[p] || !region_.contains(world, position(body))) continue;
      if (norm(velocity(body) - carrier.velocity_at(position(body))) >= speed_) continue;
      mass += body.m;
      count += 1;
    }
    return {mass, count};
  }

 private:
  static constexpr double lowest_rise = 0.1;  // of a unit normal: 6 degrees from a vertical wall

  std::vector<std::uint8_t> supported(const WorldView& world) const {
    const Particles& particles = world.particles();
    const std::size_t part = part_number(world, part_);
    const Vec3 gravity = world.settings().gravity;
    const Vec3 up = norm2(gravity) > 0 ? -normalized(gravity) : Vec3{0, 0, 1};

    std::vector<std::uint8_t> resting(particles.count());
    std::vector<std::uint32_t> queue;
    std::vector<std::vector<std::uint32_t>> above(particles.count());
    if (!world.part_present(part)) return resting;
    const auto rest = [&](std::uint32_t p) {
      if (!resting[p]) queue.push_back(p);
      resting[p] = 1;
    };
    for (const ContactRow& row : world.contacts()) {
      const double rise = dot(row.normal, up);
      const std::uint32_t i = particles.owner_of(row.i);
      if (row.part >= 0) {
        if (static_cast<std::size_t>(row.part) == part && rise > lowest_rise) rest(i);
      } else if (rise > lowest_rise) {
        above[particles.owner_of(row.j)].push_back(i);
      } else if (rise < -lowest_rise) {
        above[i].push_back(particles.owner_of(row.j));
      }
    }
    while (!queue.empty()) {
      const std::uint32_t p = queue.back();
      queue.pop_back();
      for (std::uint32_t q : above[p]) rest(q);
    }
    return resting;
  }

  RegionRef region_;
  std::string part_, carrier_;  // carrier: the part whose motion counts as rest
  double speed_;                // m/s
};

}  // namespace

std::unique_ptr<Sensor> make_residue_sensor(SensorOptions& options) {
  const RegionSettings* region = options.region("region");
  const PartSettings* part = options.part("part");
  if (!region && !part)
    throw options.error(
        "", "sensor \"" + options.settings().name + "\" of kind residue needs \"part\", \"region\" or both");
  const std::string carrier = part ? part->name : region->follows;
  const double speed = options.number("speed", "m/s", 1e-12, 1e6, 0.01);
  return std::make_unique<ResidueSensor>(region, part ? part->name : "", carrier, speed);
}

}  // namespace calx
