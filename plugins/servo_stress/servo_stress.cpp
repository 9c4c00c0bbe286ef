// servo_stress.cpp: a lid that presses with a given stress or force, step by step, calx.servo-stress.
//
// The lid has no mass: it moves as fast as the force left over drives it against a dashpot, v = (target - load) / c, up
// to a largest speed. On a bed of stiffness k the load nears its target as exp(-k t / c); c near density * speed of
// sound * area of the bed swallows waves instead of throwing them back.
#include <algorithm>
#include <calx/servo.hpp>
#include <nlohmann/json.hpp>
#include <vector>

namespace {

using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 0, -1, 1, "direction in which the part presses, of any length"),
    {"control", "stress|force", "what \"steps\" are", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"area", "m^2", "area the stress acts on; needed with \"control\": \"stress\"", 0, 1e6, 0, 0, 0},
    {"damping", "kg/s", "dashpot of the part: left-over force over speed", 1e-12, 1e12, 1, CALX_FIELD_REQUIRED, 0},
    {"speed_limit", "m/s", "largest speed of the part", 1e-9, 1e3, 0.005, 0, 0},
    {"approach_speed", "m/s",
     "speed until the part first carries a hundredth of its target; 0: no other than after that", 0, 1e3, 0, 0, 0},
    {"smoothing", "s", "time over which load and speed are averaged before they end a hold", 0, 1e6, 0.01, 0, 0},
    {"ends", "settled|time",
     "when a step ends: load and speed have settled, or after its time, so that other motions can keep pace", 0, 1, 0,
     CALX_FIELD_CHOICE, 0},
    {"tolerance", "1", "settled: the averaged load is off its target by less than this share of it", 1e-6, 1, 0.02, 0,
     0},
    {"hold_speed", "m/s", "settled: the averaged speed is below this", 1e-12, 1e3, 1e-4, 0, 0},
    {"hold", "s", "settled: for this long without a break", 0, 1e6, 0.02, 0, 0},
    {"step_time", "s", "time of a step; settled: the longest it may take", 1e-9, 1e9, 1, 0, 0},
    {"travel_limit", "m", "the run ends with an error where the part would go further than this from its place at rest",
     1e-9, 1e6, 0.1, 0, 0}};

const char schema[] =
    "{\"properties\": {"
    "\"steps\": {\"type\": \"array\", \"minItems\": 1, \"description\": \"stress, Pa, or force, N, one after the "
    "other; the last one stays\", \"items\": {\"type\": \"number\", \"exclusiveMinimum\": 0}},"
    "\"times\": {\"type\": \"array\", \"minItems\": 1, \"description\": \"time of each step, s, instead of "
    "step_time\", \"items\": {\"type\": \"number\", \"unit\": \"s\", \"exclusiveMinimum\": 0}}},"
    "\"required\": [\"steps\"]}";

// s is since the start event; step counts the steps that have ended.
enum State { way, speed, mean_load, mean_speed, step, began, quiet_since, now, touched, state_count };

class ServoStress : public calx::rigid::Servo<state_count> {
 public:
  static const calx_descriptor descriptor;

  ServoStress(const calx_host*, const calx_config& c)
      : axis_(calx::rigid::direction(descriptor, c, "axis")),
        damping_(value(c, "damping")),
        speed_limit_(value(c, "speed_limit")),
        approach_speed_(value(c, "approach_speed")),
        smoothing_(value(c, "smoothing")),
        by_time_(calx::rigid::is_choice(descriptor, c, "ends", 1)),
        tolerance_(value(c, "tolerance")),
        hold_speed_(value(c, "hold_speed")),
        hold_(value(c, "hold")),
        travel_limit_(value(c, "travel_limit")) {
    const nlohmann::json lists = nlohmann::json::parse(c.json ? std::string(c.json, c.json_size) : "{}");
    if (!lists.contains("steps"))
      throw calx::ConfigError("steps: a list of at least one stress, Pa, or force, N, is needed");
    targets_ = lists["steps"].get<std::vector<double>>();
    times_.assign(targets_.size(), value(c, "step_time"));
    if (lists.contains("times")) times_ = lists["times"].get<std::vector<double>>();
    if (times_.size() != targets_.size())
      throw calx::ConfigError("times: " + calx::rigid::number(double(times_.size())) + " times for " +
                              calx::rigid::number(double(targets_.size())) + " steps; give one for each");
    if (calx::rigid::is_choice(descriptor, c, "control", 0)) {
      const double area = value(c, "area");
      if (!(area > 0)) throw calx::ConfigError("area: 0 m^2; a stress needs the area it acts on");
      for (double& target : targets_) target *= area;
    }
  }

  void pose(calx_pose& out) const noexcept override {
    calx::rigid::set(out.displacement, axis_, state_[way]);
    calx::rigid::set(out.velocity, axis_, state_[speed]);
    const std::size_t k = present();
    out.cycle = state_[step];
    if (k < targets_.size()) out.cycle += std::min(0.999, std::max(0.0, (state_[now] - state_[began]) / times_[k]));
  }

  void advance(const calx_servo_view& view) override {
    const double load = -(view.force[0] * axis_.x + view.force[1] * axis_.y + view.force[2] * axis_.z);
    const double target = targets_[std::min(present(), targets_.size() - 1)];
    if (load > 0.01 * target) state_[touched] = 1;
    const bool approaches = approach_speed_ > 0 && !(state_[touched] > 0);
    const double v =
        approaches ? approach_speed_ : std::max(-speed_limit_, std::min(speed_limit_, (target - load) / damping_));
    const double share = view.dt / (smoothing_ + view.dt);
    state_[now] = view.time;
    state_[speed] = v;
    state_[way] += v * view.dt;
    state_[mean_load] += share * (load - state_[mean_load]);
    state_[mean_speed] += share * (v - state_[mean_speed]);
    if (std::fabs(state_[way]) > travel_limit_)
      throw calx::ConfigError("travel_limit: the part has gone " + calx::rigid::number(travel_limit_) + " m within " +
                              calx::rigid::number(view.time) + " s and carries " + calx::rigid::number(load) +
                              " N of " + calx::rigid::number(target) +
                              " N; nothing holds it, or the limit is too small");
    if (present() < targets_.size()) end_step(target, view.dt);
  }
  double top_speed(double) const noexcept override { return std::max(speed_limit_, approach_speed_); }
  double reach() const noexcept override { return travel_limit_; }

 private:
  static double value(const calx_config& c, const char* name) { return calx::parameter(descriptor, c, name); }
  std::size_t present() const noexcept { return static_cast<std::size_t>(state_[step]); }

  void end_step(double target, double dt) {
    const std::size_t k = present();
    // Half a step early rather than one late: sums of times are rounded.
    const bool over = state_[now] >= state_[began] + times_[k] - 0.5 * dt;
    bool settled = false;
    if (!by_time_) {
      const bool quiet =
          std::fabs(state_[mean_speed]) < hold_speed_ && std::fabs(state_[mean_load] - target) < tolerance_ * target;
      if (!quiet)
        state_[quiet_since] = 0;
      else if (!(state_[quiet_since] > 0))
        state_[quiet_since] = state_[now];
      settled = quiet && state_[now] >= state_[quiet_since] + hold_;
    }
    if (!over && !settled) return;
    // By the plan, so that steps of given times do not drift against other motions.
    state_[began] = by_time_ ? state_[began] + times_[k] : state_[now];
    state_[quiet_since] = 0;
    state_[step] += 1;
  }

  Vector axis_;
  double damping_, speed_limit_, approach_speed_, smoothing_;
  bool by_time_;
  double tolerance_, hold_speed_, hold_, travel_limit_;
  std::vector<double> targets_, times_;  // N; s
};

const calx_descriptor ServoStress::descriptor = {sizeof(calx_descriptor),
                                                 0,
                                                 "calx.servo-stress",
                                                 CALX_SERVO,
                                                 "Constant stress or force",
                                                 "1.0.0",
                                                 "Calx",
                                                 "Apache-2.0",
                                                 "Presses particles with a given stress or force, step by step.",
                                                 0,
                                                 fields,
                                                 sizeof fields / sizeof fields[0],
                                                 0,
                                                 schema};

}  // namespace

CALX_PLUGIN(ServoStress)
