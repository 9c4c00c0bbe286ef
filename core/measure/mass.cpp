// mass.cpp: kinds "mass" and "cycle-mass".
//
// mass: all particles whose centre of mass is in "region" (left out: everywhere). Columns mass_kg and particles_1, and
// the centre of mass of these particles, centre_x_m, centre_y_m, centre_z_m, NaN when there are none. Exact; the
// region's surface cuts particles by their centres only.
//
// cycle-mass: mass that "region" gained in each completed cycle of "motion". It starts to count when the motion starts.
// Each completed cycle makes a row due; between, rows repeat the last one. Columns: cycle_1 (cycles completed), mass_kg
// (gained in the last one), total_kg (gained since the start), mean_kg and sd_kg over the cycles from "first" (3) on,
// slope_kg, intercept_kg and r2_1 of the straight line total_kg = intercept + slope cycle over the same cycles. Mass in
// flight at the end of a cycle counts in the next. NaN while there are too few cycles.
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Content {
  double mass = 0;  // kg
  double count = 0;
  Vec3 moment;  // kg m
};

Content content_of(const WorldView& world, const RegionRef& region) {
  const Particles& particles = world.particles();
  Content content;
  for (const Record& body : particles.body) {
    if (!region.contains(world, position(body))) continue;
    content.mass += body.m;
    content.count += 1;
    content.moment += body.m * position(body);
  }
  return content;
}

class MassSensor : public Sensor {
 public:
  explicit MassSensor(const RegionSettings* region) : region_(region) {}
  std::vector<std::string> columns() const override {
    return {"mass_kg", "particles_1", "centre_x_m", "centre_y_m", "centre_z_m"};
  }
  std::vector<double> sample(const WorldView& world) override {
    const Content c = content_of(world, region_);
    const Vec3 centre = c.count > 0 ? c.moment / c.mass : Vec3{nan, nan, nan};
    return {c.mass, c.count, centre.x, centre.y, centre.z};
  }

 private:
  RegionRef region_;
};

class CycleMassSensor : public Sensor {
 public:
  CycleMassSensor(const RegionSettings& region, std::string motion, double first)
      : region_(&region), motion_(std::move(motion)), first_(first) {}

  /// Events whose firing starts the motion; none: it runs from t = 0.
  void add_start(const std::string& event) { starts_.push_back(event); }

  std::vector<std::string> columns() const override {
    return {"cycle_1", "mass_kg", "total_kg", "mean_kg", "sd_kg", "slope_kg", "intercept_kg", "r2_1"};
  }
  bool wants_every_step() const override { return true; }
  bool row_due() const override { return due_; }

  void step(const WorldView& world) override {
    if (!counting_) {
      if (!started(world)) return;
      counting_ = true;
      base_ = content_of(world, region_).mass;
    }
    // A motion's cycle is computed from the time, so the last bits of a whole number may be missing.
    const double done = std::floor(world.cycles_of(motion_) + 1e-9);
    if (done <= (cycle_.empty() ? 0 : cycle_.back())) return;
    cycle_.push_back(done);
    total_.push_back(content_of(world, region_).mass - base_);
    due_ = true;
  }

  std::vector<double> sample(const WorldView& world) override {
    step(world);
    due_ = false;
    const std::size_t n = cycle_.size();
    if (n == 0) return {0, 0, 0, nan, nan, nan, nan, nan};
    std::vector<double> row{cycle_[n - 1], gain(n - 1), total_[n - 1]};
    for (double figure : statistics()) row.push_back(figure);
    return row;
  }

  std::vector<CurveResult> curves() const override {
    CurveResult each{"mass per cycle", "cycle_1", "mass_kg", cycle_, {}};
    for (std::size_t k = 0; k < cycle_.size(); ++k) each.y.push_back(gain(k));
    return {each, {"mass after each cycle", "cycle_1", "total_kg", cycle_, total_}};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    const std::uint8_t flags[2] = {counting_, due_};
    out.put(prefix + "/flags", flags, 2);
    out.put_number(prefix + "/base", base_, "kg");
    out.put(prefix + "/cycle", cycle_.data(), cycle_.size(), "1");
    out.put(prefix + "/total", total_.data(), total_.size(), "kg");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    const std::vector<std::uint8_t> flags = in.get_u8(prefix + "/flags");
    counting_ = flags.at(0) != 0;
    due_ = flags.at(1) != 0;
    base_ = in.get_number(prefix + "/base");
    cycle_ = in.get_doubles(prefix + "/cycle");
    total_ = in.get_doubles(prefix + "/total");
  }

 private:
  bool started(const WorldView& world) const {
    if (starts_.empty() || world.cycles_of(motion_) > 0) return true;
    for (const std::string& event : starts_)
      if (world.event_time(event) >= 0) return true;
    return false;
  }
  double gain(std::size_t k) const { return total_[k] - (k ? total_[k - 1] : 0); }

  /// mean, sd, slope, intercept, r2 over the cycles from first_ on.
  std::vector<double> statistics() const {
    double n = 0, sx = 0, sy = 0, sg = 0;
    for (std::size_t k = 0; k < cycle_.size(); ++k)
      if (cycle_[k] >= first_) n += 1, sx += cycle_[k], sy += total_[k], sg += gain(k);
    double xx = 0, xy = 0, yy = 0, gg = 0;
    for (std::size_t k = 0; k < cycle_.size(); ++k) {
      if (cycle_[k] < first_) continue;
      const double dx = cycle_[k] - sx / n, dy = total_[k] - sy / n, dg = gain(k) - sg / n;
      xx += dx * dx, xy += dx * dy, yy += dy * dy, gg += dg * dg;
    }
    if (n < 1) return {nan, nan, nan, nan, nan};
    if (n < 2) return {sg, nan, nan, nan, nan};
    const double slope = xy / xx;
    return {sg / n, std::sqrt(gg / (n - 1)), slope, sy / n - slope * sx / n, yy > 0 ? xy * xy / (xx * yy) : nan};
  }

  RegionRef region_;
  std::string motion_;
  double first_;
  std::vector<std::string> starts_;
  bool counting_ = false, due_ = false;
  double base_ = 0;                    // kg in the region when the motion started
  std::vector<double> cycle_, total_;  // cycles completed; kg gained until then
};

}  // namespace

std::unique_ptr<Sensor> make_mass_sensor(SensorOptions& options) {
  return std::make_unique<MassSensor>(options.region("region"));
}

std::unique_ptr<Sensor> make_cycle_mass_sensor(SensorOptions& options) {
  const RegionSettings& region = options.required_region("region");
  const MotionSettings& motion = options.required_motion("motion");
  const double first = static_cast<double>(options.whole("first", 1, 1000000, 3));
  auto sensor = std::make_unique<CycleMassSensor>(region, motion.name, first);
  if (!motion.start.empty()) sensor->add_start(motion.start);
  // A stage begins when the one before it ends.
  const std::vector<StageSettings>& stages = options.world().stages;
  for (std::size_t k = 1; k < stages.size(); ++k)
    for (const std::string& name : stages[k].start)
      if (name == motion.name && !stages[k - 1].until.empty()) sensor->add_start(stages[k - 1].until);
  return sensor;
}

}  // namespace calx
