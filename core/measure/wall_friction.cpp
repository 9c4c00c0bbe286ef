// wall_friction.cpp: kind "wall-friction": a point of the wall yield locus for each step of "motion", and its line.
//
// Keys: those of stress_probe.hpp; "motion" whose steps are the loads; "window" (s, 0.1): the value of a step is the
// mean over its last whole window, and its drift the relative change of shear over normal stress from the window
// before; "steady" (0.02): a step counts for the line when its drift is below this; "first" (1): steps before it are
// for running in and give no row.
//
// Columns: step_1, normal_Pa, shear_Pa, ratio_1, angle_deg = arctan(ratio), drift_1, steady_1 (1 or 0), inertial_1
// (largest of the step, see StressProbe), and of the line shear = adhesion + normal tan(phi_w) through all points so
// far phi_w_deg, phi_w_se_deg, adhesion_Pa, adhesion_se_Pa with standard errors from the scatter about it. A row for
// each step; rows between two steps repeat the last one.
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/locus.hpp"
#include "measure/step_sensor.hpp"
#include "measure/stress_probe.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = 180 / 3.14159265358979323846;

const std::vector<std::string> names = {"step_1",    "normal_Pa",    "shear_Pa",    "ratio_1",
                                        "angle_deg", "drift_1",      "steady_1",    "inertial_1",
                                        "phi_w_deg", "phi_w_se_deg", "adhesion_Pa", "adhesion_se_Pa"};

class WallFrictionSensor : public StepSensor {
 public:
  explicit WallFrictionSensor(SensorOptions& options)
      : StepSensor(options.required_motion("motion").name, options.number("window", "s", 1e-9, 1e6, 0.1), names.size()),
        probe_(options),
        steady_(options.number("steady", "1", 0, 10, 0.02)),
        first_(static_cast<double>(options.whole("first", 1, 1000000, 1))) {}
  std::vector<std::string> columns() const override { return names; }

 private:
  StressState look(const WorldView& world) const override { return probe_.state(world); }
  void refresh(const WorldView& world) override { probe_.weigh(world); }

  std::vector<double> finish_step(const WorldView& world) override {
    if (steps_done() < first_) return {};
    const StressState at = windows().last();
    const double drift = windows().ratio_drift(), ratio = at.normal > 0 ? at.shear / at.normal : nan;
    const bool steady = drift < steady_;
    if (steady) points_.push_back({at.normal, at.shear});
    const Locus line = fit_locus(points_);
    return {steps_done(),
            at.normal,
            at.shear,
            ratio,
            std::atan(ratio) * degree,
            drift,
            steady ? 1.0 : 0.0,
            StressProbe::inertial(world, windows().haste()),
            line.angle() * degree,
            line.angle_error() * degree,
            line.intercept,
            line.intercept_error};
  }

  std::vector<double> numbers() const override {
    std::vector<double> out{probe_.below()};
    for (const StressPoint& p : points_) out.insert(out.end(), {p.normal, p.shear});
    return out;
  }
  void set_numbers(const std::vector<double>& n) override {
    probe_.set_below(n.at(0));
    points_.clear();
    for (std::size_t k = 1; k + 1 < n.size(); k += 2) points_.push_back({n[k], n[k + 1]});
  }

  StressProbe probe_;
  double steady_, first_;
  std::vector<StressPoint> points_;
};

}  // namespace

std::unique_ptr<Sensor> make_wall_friction_sensor(SensorOptions& options) {
  return std::make_unique<WallFrictionSensor>(options);
}

}  // namespace calx
