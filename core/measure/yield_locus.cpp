// yield_locus.cpp: kind "yield-locus": a shear test after Jenike (ASTM D6128): pre-shear points, yield points, the
// locus and what follows from it.
//
// Keys: those of stress_probe.hpp; "motion" whose steps are the parts of the test; "pattern": what its steps are, over
// and over (["pre-shear", "rest", "shear"]); "window" (s, 0.05): the value of a pre-shear is the mean over its last
// whole window, that of a shear step the window with the largest shear stress; "steady" (0.05): a pre-shear has reached
// its steady state when shear over normal stress changes by less than this from the window before to the last;
// "prorate" (true): each yield point is multiplied by mean pre-shear stress over its own pre-shear stress, which takes
// out how well each was made. Pre-shears whose normal stresses differ by less than 20 % belong to one locus; a further
// level begins the next one.
//
// Columns: step_1, role_1 (1 pre-shear, 2 shear, 0 rest), level_1, normal_Pa, shear_Pa (as measured), prorated_Pa,
// drift_1, steady_1 (of the latest pre-shear), inertial_1 (NaN for rest), and of the level's locus so far: phi_deg,
// phi_se_deg, cohesion_Pa, cohesion_se_Pa, strength_Pa, sigma1_Pa, sigma3_Pa, ffc_1, effective_deg, steady_deg (see
// locus.hpp). A row for each step; rows between two steps repeat the last one.
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

enum Role { rest, pre_shear, shear };

struct YieldPoint {
  StressPoint at;
  double pre_shear = 0;  // Pa, shear stress of the pre-shear it follows
};

const std::vector<std::string> names = {"step_1",      "role_1",      "level_1",        "normal_Pa",   "shear_Pa",
                                        "prorated_Pa", "drift_1",     "steady_1",       "inertial_1",  "phi_deg",
                                        "phi_se_deg",  "cohesion_Pa", "cohesion_se_Pa", "strength_Pa", "sigma1_Pa",
                                        "sigma3_Pa",   "ffc_1",       "effective_deg",  "steady_deg"};

class YieldLocusSensor : public StepSensor {
 public:
  YieldLocusSensor(SensorOptions& options, std::vector<Role> pattern)
      : StepSensor(options.required_motion("motion").name, options.number("window", "s", 1e-9, 1e6, 0.05),
                   names.size()),
        probe_(options),
        steady_(options.number("steady", "1", 0, 10, 0.05)),
        prorate_(options.flag("prorate", true)),
        pattern_(std::move(pattern)) {}
  std::vector<std::string> columns() const override { return names; }

 private:
  StressState look(const WorldView& world) const override { return probe_.state(world); }
  void refresh(const WorldView& world) override { probe_.weigh(world); }

  std::vector<double> finish_step(const WorldView& world) override {
    const Role role = pattern_[static_cast<std::size_t>(steps_done() - 1) % pattern_.size()];
    const StressState at = role == shear ? windows().peak() : windows().last();
    if (role == pre_shear) add_pre_shear({at.normal, at.shear});
    if (role == shear && !pre_shears_.empty()) points_.push_back({{at.normal, at.shear}, pre_shears_.back().shear});
    const double share = role == shear ? prorating(pre_shears_.empty() ? nan : pre_shears_.back().shear) : nan;
    std::vector<double> row{steps_done(),
                            static_cast<double>(role),
                            level_,
                            at.normal,
                            at.shear,
                            at.shear * share,
                            drift_,
                            drift_ < steady_ ? 1.0 : 0.0,
                            role == rest ? nan : StressProbe::inertial(world, windows().haste())};
    add_locus(row);
    return row;
  }

  std::vector<double> numbers() const override {
    std::vector<double> out{probe_.below(), level_, drift_, static_cast<double>(points_.size())};
    for (const YieldPoint& p : points_) out.insert(out.end(), {p.at.normal, p.at.shear, p.pre_shear});
    for (const StressPoint& p : pre_shears_) out.insert(out.end(), {p.normal, p.shear});
    return out;
  }
  void set_numbers(const std::vector<double>& n) override {
    probe_.set_below(n.at(0));
    level_ = n.at(1);
    drift_ = n.at(2);
    points_.resize(static_cast<std::size_t>(n.at(3)));
    std::size_t at = 4;
    for (YieldPoint& p : points_) {
      p = {{n.at(at), n.at(at + 1)}, n.at(at + 2)};
      at += 3;
    }
    pre_shears_.clear();
    for (; at + 1 < n.size(); at += 2) pre_shears_.push_back({n[at], n[at + 1]});
  }

  void add_pre_shear(const StressPoint& point) {
    drift_ = windows().ratio_drift();
    if (pre_shears_.empty() || std::fabs(point.normal - pre_shears_[0].normal) > 0.2 * pre_shears_[0].normal) {
      pre_shears_.clear();
      points_.clear();
      level_ += 1;
    }
    pre_shears_.push_back(point);
  }

  StressPoint mean_pre_shear() const {
    StressPoint mean;
    const double n = static_cast<double>(pre_shears_.size());
    for (const StressPoint& p : pre_shears_) mean.normal += p.normal / n, mean.shear += p.shear / n;
    return mean;
  }
  double prorating(double pre) const { return prorate_ ? mean_pre_shear().shear / pre : 1; }

  void add_locus(std::vector<double>& row) const {
    std::vector<StressPoint> prorated;
    for (const YieldPoint& p : points_) prorated.push_back({p.at.normal, p.at.shear * prorating(p.pre_shear)});
    const Locus line = fit_locus(prorated);
    const FlowProperties flow = flow_properties(line, mean_pre_shear());
    for (const double figure :
         {line.angle() * degree, line.angle_error() * degree, line.intercept, line.intercept_error, flow.strength,
          flow.sigma1, flow.sigma3, flow.ffc, flow.effective_angle * degree, flow.steady_angle * degree})
      row.push_back(figure);
  }

  StressProbe probe_;
  double steady_;
  bool prorate_;
  std::vector<Role> pattern_;
  std::vector<YieldPoint> points_;       // of the present level
  std::vector<StressPoint> pre_shears_;  // of the present level
  double level_ = 0, drift_ = nan;
};

}  // namespace

std::unique_ptr<Sensor> make_yield_locus_sensor(SensorOptions& options) {
  const std::vector<std::string> roles = {"rest", "pre-shear", "shear"};
  std::vector<Role> pattern;
  for (const std::size_t role : options.choices("pattern", roles)) pattern.push_back(static_cast<Role>(role));
  if (pattern.empty()) pattern = {pre_shear, rest, shear};
  return std::make_unique<YieldLocusSensor>(options, std::move(pattern));
}

}  // namespace calx
