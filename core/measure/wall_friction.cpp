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
#include "measure/stress_probe.hpp"

namespace calx {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = 180 / 3.14159265358979323846;

class WallFrictionSensor : public Sensor {
 public:
  explicit WallFrictionSensor(SensorOptions& options)
      : probe_(options),
        count_(options.required_motion("motion").name),
        windows_(options.number("window", "s", 1e-9, 1e6, 0.1)),
        steady_(options.number("steady", "1", 0, 10, 0.02)),
        first_(static_cast<double>(options.whole("first", 1, 1000000, 1))) {}
  std::vector<std::string> columns() const override {
    return {"step_1",   "normal_Pa",  "shear_Pa",  "ratio_1",      "angle_deg",   "drift_1",
            "steady_1", "inertial_1", "phi_w_deg", "phi_w_se_deg", "adhesion_Pa", "adhesion_se_Pa"};
  }
  bool wants_every_step() const override { return true; }
  bool row_due() const override { return due_; }

  void step(const WorldView& world) override {
    windows_.add(probe_.state(world), world.time_step());
    if (!count_.ended(world)) return;
    if (count_.done() >= first_) {
      finish_step(world);
      due_ = true;
    }
    windows_.begin();
  }
  std::vector<double> sample(const WorldView& world) override {
    due_ = false;
    probe_.weigh(world);
    return row_;
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    const std::vector<double> numbers = windows_.numbers();
    out.put(prefix + "/windows", numbers.data(), numbers.size(), "");
    out.put(prefix + "/row", row_.data(), row_.size(), "");
    std::vector<double> points;
    for (const StressPoint& p : points_) points.insert(points.end(), {p.normal, p.shear});
    out.put(prefix + "/points", points.data(), points.size(), "Pa");
    const double rest[] = {count_.done(), due_ ? 1.0 : 0.0, probe_.below()};
    out.put(prefix + "/rest", rest, 3, "1,1,N");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    windows_.set_numbers(in.get_doubles(prefix + "/windows"));
    row_ = in.get_doubles(prefix + "/row");
    row_.resize(columns().size(), nan);
    const std::vector<double> points = in.get_doubles(prefix + "/points"), rest = in.get_doubles(prefix + "/rest");
    points_.clear();
    for (std::size_t k = 0; k + 1 < points.size(); k += 2) points_.push_back({points[k], points[k + 1]});
    count_.set_done(rest.at(0));
    due_ = rest.at(1) != 0;
    probe_.set_below(rest.at(2));
  }

 private:
  void finish_step(const WorldView& world) {
    const StressState at = windows_.last();
    const double drift = windows_.ratio_drift(), ratio = at.normal > 0 ? at.shear / at.normal : nan;
    const bool steady = drift < steady_;
    if (steady) points_.push_back({at.normal, at.shear});
    const Locus line = fit_locus(points_);
    row_ = {count_.done(),
            at.normal,
            at.shear,
            ratio,
            std::atan(ratio) * degree,
            drift,
            steady ? 1.0 : 0.0,
            StressProbe::inertial(world, windows_.haste()),
            line.angle() * degree,
            line.angle_error() * degree,
            line.intercept,
            line.intercept_error};
  }

  StressProbe probe_;
  StepCount count_;
  Windows windows_;
  double steady_, first_;
  std::vector<StressPoint> points_;
  std::vector<double> row_{0, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan};
  bool due_ = false;
};

}  // namespace

std::unique_ptr<Sensor> make_wall_friction_sensor(SensorOptions& options) {
  return std::make_unique<WallFrictionSensor>(options);
}

}  // namespace calx
