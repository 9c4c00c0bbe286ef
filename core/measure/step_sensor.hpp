// step_sensor.hpp: what the sensors share that give a row for each step of a motion: a load of a lid, a leg of a stem,
// a tap. Private to measure/.
#pragma once
#include <string>
#include <vector>

#include "measure/measure.hpp"
#include "measure/windows.hpp"

namespace calx {

/// Gathers windows over a step and asks for its row when the motion's cycle has grown by one. Rows between two steps
/// repeat the last one; before the first, step_1 is 0 and the other columns are NaN, or what before_first gave.
class StepSensor : public Sensor {
 public:
  /// window: s; width: number of columns.
  StepSensor(std::string motion, double window, std::size_t width);
  bool wants_every_step() const override { return true; }
  bool row_due() const override { return due_; }
  void step(const WorldView& world) override;
  std::vector<double> sample(const WorldView& world) override;
  void save(StateWriter& out, const std::string& prefix) const override;
  void load(const StateReader& in, const std::string& prefix) override;

 protected:
  /// Of the last time step.
  virtual StressState look(const WorldView& world) const = 0;
  /// The row of the step that has just ended; empty: it gives none.
  virtual std::vector<double> finish_step(const WorldView& world) = 0;
  /// The row of the state in which the motion begins, with step_1 0; empty: there is none, or it was given already.
  /// Called after each time step of the motion's first step.
  virtual std::vector<double> before_first(const WorldView&) { return {}; }
  /// Figures that are looked up once a row.
  virtual void refresh(const WorldView&) {}
  /// What else belongs into a checkpoint.
  virtual std::vector<double> numbers() const { return {}; }
  virtual void set_numbers(const std::vector<double>&) {}
  const Windows& windows() const { return windows_; }
  double steps_done() const { return done_; }

 private:
  void take(std::vector<double> row);

  std::string motion_;
  Windows windows_;
  double done_ = 0;  // steps of the motion
  std::vector<double> row_;
  bool due_ = false;
};

}  // namespace calx
