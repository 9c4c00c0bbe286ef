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
// drift_1, steady_1 (of the latest pre-shear), inertial_1, and of the level's locus so far: phi_deg, phi_se_deg,
// cohesion_Pa, cohesion_se_Pa, strength_Pa, sigma1_Pa, sigma3_Pa, ffc_1, effective_deg, steady_deg (see locus.hpp). A
// row for each step; rows between two steps repeat the last one.
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/locus.hpp"
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

class YieldLocusSensor : public Sensor {
 public:
  YieldLocusSensor(SensorOptions& options, std::vector<Role> pattern)
      : probe_(options),
        count_(options.required_motion("motion").name),
        windows_(options.number("window", "s", 1e-9, 1e6, 0.05)),
        steady_(options.number("steady", "1", 0, 10, 0.05)),
        prorate_(options.flag("prorate", true)),
        pattern_(std::move(pattern)) {
    row_.assign(columns().size(), nan);
    row_[0] = 0;
  }
  std::vector<std::string> columns() const override {
    return {"step_1",    "role_1",     "level_1", "normal_Pa",     "shear_Pa",    "prorated_Pa",    "drift_1",
            "steady_1",  "inertial_1", "phi_deg", "phi_se_deg",    "cohesion_Pa", "cohesion_se_Pa", "strength_Pa",
            "sigma1_Pa", "sigma3_Pa",  "ffc_1",   "effective_deg", "steady_deg"};
  }
  bool wants_every_step() const override { return true; }
  bool row_due() const override { return due_; }

  void step(const WorldView& world) override {
    windows_.add(probe_.state(world), world.time_step());
    if (!count_.ended(world)) return;
    finish_step(world);
    windows_.begin();
    due_ = true;
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
    std::vector<double> points, pre;
    for (const YieldPoint& p : points_) points.insert(points.end(), {p.at.normal, p.at.shear, p.pre_shear});
    for (const StressPoint& p : pre_shears_) pre.insert(pre.end(), {p.normal, p.shear});
    out.put(prefix + "/points", points.data(), points.size(), "Pa");
    out.put(prefix + "/pre_shears", pre.data(), pre.size(), "Pa");
    const double others[] = {count_.done(), due_ ? 1.0 : 0.0, probe_.below(), level_, drift_};
    out.put(prefix + "/rest", others, 5, "1,1,N,1,1");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    windows_.set_numbers(in.get_doubles(prefix + "/windows"));
    row_ = in.get_doubles(prefix + "/row");
    row_.resize(columns().size(), nan);
    const std::vector<double> points = in.get_doubles(prefix + "/points"), pre = in.get_doubles(prefix + "/pre_shears"),
                              others = in.get_doubles(prefix + "/rest");
    points_.clear();
    pre_shears_.clear();
    for (std::size_t k = 0; k + 2 < points.size(); k += 3)
      points_.push_back({{points[k], points[k + 1]}, points[k + 2]});
    for (std::size_t k = 0; k + 1 < pre.size(); k += 2) pre_shears_.push_back({pre[k], pre[k + 1]});
    count_.set_done(others.at(0));
    due_ = others.at(1) != 0;
    probe_.set_below(others.at(2));
    level_ = others.at(3);
    drift_ = others.at(4);
  }

 private:
  void finish_step(const WorldView& world) {
    const Role role = pattern_[static_cast<std::size_t>(count_.done() - 1) % pattern_.size()];
    const StressState at = role == shear ? windows_.peak() : windows_.last();
    if (role == pre_shear) add_pre_shear({at.normal, at.shear});
    if (role == shear && !pre_shears_.empty()) points_.push_back({{at.normal, at.shear}, pre_shears_.back().shear});
    const double share = role == shear ? prorating(pre_shears_.empty() ? nan : pre_shears_.back().shear) : nan;
    row_ = {count_.done(),
            static_cast<double>(role),
            level_,
            at.normal,
            at.shear,
            at.shear * share,
            drift_,
            drift_ < steady_ ? 1.0 : 0.0,
            StressProbe::inertial(world, windows_.haste())};
    add_locus();
  }

  void add_pre_shear(const StressPoint& point) {
    drift_ = windows_.ratio_drift();
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

  void add_locus() {
    std::vector<StressPoint> prorated;
    for (const YieldPoint& p : points_) prorated.push_back({p.at.normal, p.at.shear * prorating(p.pre_shear)});
    const Locus line = fit_locus(prorated);
    const FlowProperties flow = flow_properties(line, mean_pre_shear());
    for (const double figure :
         {line.angle() * degree, line.angle_error() * degree, line.intercept, line.intercept_error, flow.strength,
          flow.sigma1, flow.sigma3, flow.ffc, flow.effective_angle * degree, flow.steady_angle * degree})
      row_.push_back(figure);
  }

  StressProbe probe_;
  StepCount count_;
  Windows windows_;
  double steady_;
  bool prorate_;
  std::vector<Role> pattern_;
  std::vector<YieldPoint> points_;       // of the present level
  std::vector<StressPoint> pre_shears_;  // of the present level
  std::vector<double> row_;
  double level_ = 0, drift_ = nan;
  bool due_ = false;
};

}  // namespace

std::unique_ptr<Sensor> make_yield_locus_sensor(SensorOptions& options) {
  const std::vector<std::string> names = {"rest", "pre-shear", "shear"};
  std::vector<Role> pattern;
  for (const std::size_t role : options.choices("pattern", names)) pattern.push_back(static_cast<Role>(role));
  if (pattern.empty()) pattern = {pre_shear, rest, shear};
  return std::make_unique<YieldLocusSensor>(options, std::move(pattern));
}

}  // namespace calx
