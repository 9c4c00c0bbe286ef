// servo_speed.cpp: a drive with a speed for each leg of its way that stops where the load reaches a bound,
// calx.servo-speed: the stem of a shear cell, pushed, drawn back until it carries nothing, pushed again.
#include <algorithm>
#include <calx/servo.hpp>
#include <nlohmann/json.hpp>
#include <vector>

namespace {

using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 1, 0, 0, 1, "direction of positive speeds, of any length"),
    {"smoothing", "s", "time over which the load is averaged before it is held against \"stop_at\"", 0, 1e6, 0.005, 0,
     0},
    {"travel_limit", "m", "the run ends with an error where the part would go further than this from its place at rest",
     1e-9, 1e6, 0.1, 0, 0}};

const char schema[] =
    "{\"properties\": {"
    "\"legs\": {\"type\": \"array\", \"minItems\": 1, \"description\": \"legs, one after the other; rest after the "
    "last\", \"items\": {\"type\": \"object\", \"required\": [\"speed\", \"duration\"], \"additionalProperties\": "
    "false, \"properties\": {"
    "\"speed\": {\"type\": \"number\", \"unit\": \"m/s\", \"description\": \"along the axis; negative: back\"},"
    "\"duration\": {\"type\": \"number\", \"unit\": \"s\", \"exclusiveMinimum\": 0},"
    "\"stop_at\": {\"type\": \"number\", \"unit\": \"N\", \"description\": \"rest for what is left of the leg once the "
    "averaged load against the axis has risen to this (positive speed) or fallen to it (negative speed)\"}}}}},"
    "\"required\": [\"legs\"]}";

struct Leg {
  double speed, duration, stop_at;
  bool stops;
};

// leg counts the legs that have ended; stopped is 1 once the bound of the present one was met.
enum State { way, speed, mean_load, leg, began, stopped, now, state_count };

class ServoSpeed : public calx::rigid::Servo<state_count> {
 public:
  static const calx_descriptor descriptor;

  ServoSpeed(const calx_host*, const calx_config& c)
      : axis_(calx::rigid::direction(descriptor, c, "axis")),
        smoothing_(calx::parameter(descriptor, c, "smoothing")),
        travel_limit_(calx::parameter(descriptor, c, "travel_limit")) {
    const nlohmann::json lists = nlohmann::json::parse(c.json ? std::string(c.json, c.json_size) : "{}");
    if (!lists.contains("legs")) throw calx::ConfigError("legs: a list of at least one leg is needed");
    for (const auto& one : lists["legs"]) {
      const bool stops = one.contains("stop_at");
      legs_.push_back(
          {one["speed"].get<double>(), one["duration"].get<double>(), stops ? one["stop_at"].get<double>() : 0, stops});
    }
  }

  void pose(calx_pose& out) const noexcept override {
    calx::rigid::set(out.displacement, axis_, state_[way]);
    calx::rigid::set(out.velocity, axis_, state_[speed]);
    const std::size_t k = present();
    out.cycle = state_[leg];
    if (k < legs_.size())
      out.cycle += std::min(0.999, std::max(0.0, (state_[now] - state_[began]) / legs_[k].duration));
  }

  void advance(const calx_servo_view& view) override {
    const double load = -(view.force[0] * axis_.x + view.force[1] * axis_.y + view.force[2] * axis_.z);
    state_[mean_load] += view.dt / (smoothing_ + view.dt) * (load - state_[mean_load]);
    state_[now] = view.time;
    state_[speed] = 0;
    if (present() >= legs_.size()) return;
    const Leg& at = legs_[present()];
    const bool reached = at.speed >= 0 ? state_[mean_load] >= at.stop_at : state_[mean_load] <= at.stop_at;
    if (at.stops && reached) state_[stopped] = 1;
    if (!(state_[stopped] > 0)) state_[speed] = at.speed;
    state_[way] += state_[speed] * view.dt;
    if (std::fabs(state_[way]) > travel_limit_)
      throw calx::ConfigError("travel_limit: the part has gone " + calx::rigid::number(travel_limit_) + " m within " +
                              calx::rigid::number(view.time) + " s, in leg " + calx::rigid::number(state_[leg] + 1));
    // Half a step early rather than one late: sums of times are rounded.
    if (view.time < state_[began] + at.duration - 0.5 * view.dt) return;
    state_[began] += at.duration;
    state_[stopped] = 0;
    state_[leg] += 1;
  }
  double top_speed(double) const noexcept override {
    double fastest = 0;
    for (const Leg& l : legs_) fastest = std::max(fastest, std::fabs(l.speed));
    return fastest;
  }
  double reach() const noexcept override { return travel_limit_; }

 private:
  std::size_t present() const noexcept { return static_cast<std::size_t>(state_[leg]); }

  Vector axis_;
  double smoothing_, travel_limit_;
  std::vector<Leg> legs_;
};

const calx_descriptor ServoSpeed::descriptor = {
    sizeof(calx_descriptor),
    0,
    "calx.servo-speed",
    CALX_SERVO,
    "Speed with a bound on the load",
    "1.0.0",
    "Calx",
    "Apache-2.0",
    "Drives at given speeds, leg by leg, and stops where the load reaches a bound.",
    0,
    fields,
    sizeof fields / sizeof fields[0],
    0,
    schema};

}  // namespace

CALX_PLUGIN(ServoSpeed)
