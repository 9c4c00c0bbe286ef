// part_load.cpp: kind "part-load": force and torque of the particles on "part", and the power they give it.
//
// World frame; torque about the part's pivot where it is now. Columns: force_x_N ... force_z_N, torque_x_N_m ...
// torque_z_N_m, power_W = force . pivot velocity + torque . spin (negative: the drive works on the particles).
// Load of the last step, exact, but noisy as single contacts are; with "every_step": true each row holds the mean over
// the steps since the row before, and mass that hits within the interval is not missed. A part that is not in the world
// has no load.
#include <array>

#include "measure/kinds.hpp"
#include "measure/region_ref.hpp"

namespace calx {

namespace {

class PartLoadSensor : public Sensor {
 public:
  PartLoadSensor(std::string part, bool every_step) : part_(std::move(part)), every_step_(every_step) {}
  std::vector<std::string> columns() const override {
    return {"force_x_N", "force_y_N", "force_z_N", "torque_x_N_m", "torque_y_N_m", "torque_z_N_m", "power_W"};
  }
  bool wants_every_step() const override { return every_step_; }

  void step(const WorldView& world) override {
    const Figures now = figures(world);
    for (std::size_t k = 0; k < now.size(); ++k) sum_[k] += now[k];
    steps_ += 1;
  }
  std::vector<double> sample(const WorldView& world) override {
    Figures row = figures(world);
    if (steps_ > 0) {
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = sum_[k] / steps_;
      sum_.fill(0);
      steps_ = 0;
    }
    return {row.begin(), row.end()};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    out.put(prefix + "/sum", sum_.data(), sum_.size(), "");
    out.put_number(prefix + "/steps", steps_, "1");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    const std::vector<double> sum = in.get_doubles(prefix + "/sum");
    for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] = sum.at(k);
    steps_ = in.get_number(prefix + "/steps");
  }

 private:
  using Figures = std::array<double, 7>;

  Figures figures(const WorldView& world) const {
    const std::size_t part = part_number(world, part_);
    if (!world.part_present(part)) return {};
    const PartLoad load = world.part_load(part);
    const Pose pose = world.part_pose(part);
    const double power = dot(load.force, pose.velocity) + dot(load.torque, pose.spin);
    return {load.force.x, load.force.y, load.force.z, load.torque.x, load.torque.y, load.torque.z, power};
  }

  std::string part_;
  bool every_step_;
  Figures sum_{};  // over the steps since the last row
  double steps_ = 0;
};

}  // namespace

std::unique_ptr<Sensor> make_part_load_sensor(SensorOptions& options) {
  const PartSettings* part = options.part("part");
  if (!part) throw options.error("", "sensor \"" + options.settings().name + "\" of kind part-load needs \"part\"");
  return std::make_unique<PartLoadSensor>(part->name, options.flag("every_step", false));
}

}  // namespace calx
