// cell_density.cpp: kind "cell-density": height and density of the powder in a cell at the end of each step of
// "motion": loads of a lid, or taps.
//
// With a lid: "lid" (part), "height" (m, from the floor to the lid's face as drawn), "floor" (part, where it moves
// too), "up" ([0, 0, 1]); the stress is the lid's load over "area". Without: "region", a cylinder or box that stands on
// the floor and follows the cell; the height is the mean of the upper envelope of the spheres over the region (cells of
// a 48th of its width), bare floor counting as 0. The envelope lies above the level a ruler would find by a part of a
// particle. The first row, of step 0, is that of the bed as poured, before the first tap. "area" (m^2) is that of the
// bed, "window" (s, 0.02) as in wall-friction: stress and height are means over the last whole window of the step.
// "region" says which particles count; without, all.
//
// Columns: step_1, stress_Pa (NaN without lid), height_m, volume_m3, density_kg_m3, solid_fraction_1, cps_percent = 100
// (V0 - V) / V0 from the first row, drift_1 (relative change of height from the window before to the last), speed_m_s
// of the lid then, inertial_1 = largest of rate * d * sqrt(density / stress) of the step's windows, rate = speed /
// height. A row for each step; rows between two steps repeat the last one.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/height_map.hpp"
#include "measure/kinds.hpp"
#include "measure/step_sensor.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct CellSettings {
  std::string lid, floor, motion;
  double area = 0, height = 0;  // m^2, m
  Vec3 up{0, 0, 1};
};

const std::vector<std::string> names = {"step_1",           "stress_Pa",   "height_m", "volume_m3", "density_kg_m3",
                                        "solid_fraction_1", "cps_percent", "drift_1",  "speed_m_s", "inertial_1"};

class CellDensitySensor : public StepSensor {
 public:
  CellDensitySensor(CellSettings cell, const RegionSettings* region, double window)
      : StepSensor(cell.motion, window, names.size()), cell_(std::move(cell)), region_(region) {}
  std::vector<std::string> columns() const override { return names; }

 private:
  StressState look(const WorldView& world) const override {
    return cell_.lid.empty() ? StressState() : under_lid(world);
  }
  std::vector<double> numbers() const override { return {first_volume_}; }
  void set_numbers(const std::vector<double>& n) override { first_volume_ = n.at(0); }

  StressState under_lid(const WorldView& world) const {
    const std::size_t lid = part_number(world, cell_.lid);
    Vec3 shift = world.part_pose(lid).shift, speed = world.part_pose(lid).velocity;
    if (!cell_.floor.empty()) {
      const Pose floor = world.part_pose(part_number(world, cell_.floor));
      shift = shift - floor.shift;
      speed = speed - floor.velocity;
    }
    StressState now;
    now.normal = dot(world.part_load(lid).force, cell_.up) / cell_.area;
    now.height = cell_.height + dot(shift, cell_.up);
    now.speed = std::fabs(dot(speed, cell_.up));
    return now;
  }

  double surface_height(const WorldView& world) const {
    const Box box = region_.bounds(world);
    const double cell = std::max(box.hi.x - box.lo.x, box.hi.y - box.lo.y) / 48;
    HeightMap map(box.lo, box.hi, cell);
    for (const Record* sphere : spheres_in(world, region_)) map.add(*sphere);
    const double low = box.lo.z + 1e-9 * (box.hi.z - box.lo.z);
    double sum = 0, cells = 0;
    for (std::size_t j = 0; j < map.ny(); ++j)
      for (std::size_t i = 0; i < map.nx(); ++i) {
        if (!region_.contains(world, {map.x(i), map.y(j), low})) continue;
        cells += 1;
        if (std::isfinite(map.at(i, j))) sum += map.at(i, j) - box.lo.z;
      }
    return cells > 0 ? sum / cells : nan;
  }

  std::vector<double> before_first(const WorldView& world) override {
    const bool wanted = cell_.lid.empty() && std::isnan(first_volume_);
    return wanted ? finish_step(world) : std::vector<double>();
  }

  std::vector<double> finish_step(const WorldView& world) override {
    const Particles& particles = world.particles();
    double mass = 0, solid = 0;
    for (std::size_t p = 0; p < particles.count(); ++p) {
      if (!region_.contains(world, position(particles.body[p]))) continue;
      mass += particles.body[p].m;
      solid += particles.body[p].m / particles.density[particles.material[p]];
    }
    const bool lid = !cell_.lid.empty();
    StressState at = windows().last();
    if (!lid) at.height = surface_height(world), at.normal = at.speed = nan;
    const double volume = cell_.area * at.height;
    if (std::isnan(first_volume_)) first_volume_ = volume;
    double inertial = nan;
    if (lid && particles.count() > 0)
      inertial = windows().haste() / at.height * 2 * particles.equal_radius(0) *
                 std::sqrt(particles.density[particles.material[0]]);
    return {steps_done(),
            at.normal,
            at.height,
            volume,
            mass / volume,
            solid / volume,
            100 * (first_volume_ - volume) / first_volume_,
            lid ? windows().height_drift() : nan,
            at.speed,
            inertial};
  }

  CellSettings cell_;
  RegionRef region_;
  double first_volume_ = nan;  // m^3, of the first row
};

}  // namespace

std::unique_ptr<Sensor> make_cell_density_sensor(SensorOptions& options) {
  CellSettings cell;
  cell.motion = options.required_motion("motion").name;
  cell.area = options.required_number("area", "m^2", 1e-12, 1e6);
  const RegionSettings* region = options.region("region");
  if (const PartSettings* lid = options.part("lid")) {
    cell.lid = lid->name;
    cell.height = options.required_number("height", "m", 1e-9, 1e6);
    if (const PartSettings* floor = options.part("floor")) cell.floor = floor->name;
    if (options.has("up")) cell.up = options.vector("up", "1");
    if (!(norm2(cell.up) > 0)) throw options.error("up", "has no direction; give a vector of any length but 0");
    cell.up = normalized(cell.up);
  } else if (!region) {
    throw options.error("",
                        "sensor \"" + options.settings().name +
                            "\" of kind cell-density needs \"lid\", the part that presses, or \"region\", the space "
                            "of the bed");
  }
  return std::make_unique<CellDensitySensor>(cell, region, options.number("window", "s", 1e-9, 1e6, 0.02));
}

}  // namespace calx
