#include "measure/step_sensor.hpp"

#include <cmath>
#include <limits>

namespace calx {

StepSensor::StepSensor(std::string motion, double window, std::size_t width)
    : motion_(std::move(motion)), windows_(window), row_(width, std::numeric_limits<double>::quiet_NaN()) {
  row_[0] = 0;
}

void StepSensor::step(const WorldView& world) {
  windows_.add(look(world), world.time_step());
  // A motion's cycle is computed from the time, so the last bits of a whole number may be missing.
  const double cycles = world.cycles_of(motion_), done = std::floor(cycles + 1e-9);
  if (cycles > 0 && done_ == 0 && done == 0) take(before_first(world));
  if (done <= done_) return;
  done_ = done;
  take(finish_step(world));
  windows_.begin();
}

void StepSensor::take(std::vector<double> row) {
  if (row.empty()) return;
  row_ = std::move(row);
  due_ = true;
}

std::vector<double> StepSensor::sample(const WorldView& world) {
  due_ = false;
  refresh(world);
  return row_;
}

void StepSensor::save(StateWriter& out, const std::string& prefix) const {
  const std::vector<double> windows = windows_.numbers(), more = numbers();
  out.put(prefix + "/windows", windows.data(), windows.size(), "");
  out.put(prefix + "/row", row_.data(), row_.size(), "");
  out.put(prefix + "/numbers", more.data(), more.size(), "");
  const double count[] = {done_, due_ ? 1.0 : 0.0};
  out.put(prefix + "/count", count, 2, "1");
}

void StepSensor::load(const StateReader& in, const std::string& prefix) {
  windows_.set_numbers(in.get_doubles(prefix + "/windows"));
  const std::vector<double> row = in.get_doubles(prefix + "/row"), count = in.get_doubles(prefix + "/count");
  for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = row.at(k);
  set_numbers(in.get_doubles(prefix + "/numbers"));
  done_ = count.at(0);
  due_ = count.at(1) != 0;
}

}  // namespace calx
