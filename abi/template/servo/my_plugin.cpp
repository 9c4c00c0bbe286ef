// my_plugin.cpp: pushes a part with a force, against the load of the particles and a dashpot, the servo
// org.example.my-plugin. A servo goes from step to step and reacts to loads; what depends on time alone is a motion.
#include <calx/servo.hpp>

namespace {

using calx::rigid::Vector;

// name, unit, meaning, lowest, highest, preset, flags, 0.
const calx_field fields[] = {
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 0, -1, 1, "direction of the push, of any length"),
    {"force", "N", "push along the axis", 0, 1e9, 1, 0, 0},
    {"dashpot", "kg/s", "speed is what is left of the force over this", 1e-6, 1e12, 100, 0, 0},
    {"travel_limit", "m", "the run ends with an error where the part would go further from its place at rest", 1e-9, 1e6,
     0.1, 0, 0}};

// All that the servo remembers: saved in checkpoints, 0 at the start.
enum State { way, speed, state_count };

class MyPlugin : public calx::rigid::Servo<state_count> {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host*, const calx_config& c)
      : axis_(calx::rigid::direction(descriptor, c, "axis")),
        force_(calx::parameter(descriptor, c, "force")),
        dashpot_(calx::parameter(descriptor, c, "dashpot")),
        travel_limit_(calx::parameter(descriptor, c, "travel_limit")) {}

  // One step on. The load is one step old: where the dashpot is below stiffness of the bed times step, it swings.
  void advance(const calx_servo_view& view) override {
    const double load = view.force[0] * axis_.x + view.force[1] * axis_.y + view.force[2] * axis_.z;
    const double most = top_speed(0);
    state_[speed] = std::fmax(-most, std::fmin((force_ + load) / dashpot_, most));
    state_[way] += state_[speed] * view.dt;
    if (std::fabs(state_[way]) > travel_limit_)
      throw calx::ConfigError("travel_limit: the part has gone " + calx::rigid::number(travel_limit_) + " m within " +
                              calx::rigid::number(view.time) + " s; lower the force or give it something to push");
  }
  void pose(calx_pose& out) const noexcept override {
    calx::rigid::set(out.displacement, axis_, state_[way]);
    calx::rigid::set(out.velocity, axis_, state_[speed]);
  }
  double top_speed(double) const noexcept override { return force_ / dashpot_; }
  double reach() const noexcept override { return travel_limit_; }

 private:
  Vector axis_;
  double force_, dashpot_, travel_limit_;
};

const calx_descriptor MyPlugin::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "org.example.my-plugin",
                                              CALX_SERVO,
                                              "my-plugin",
                                              "0.1.0",
                                              "Example",
                                              "MIT",
                                              "Pushes with a force, against the load and a dashpot.",
                                              nullptr,
                                              fields,
                                              sizeof fields / sizeof fields[0],
                                              0,
                                              nullptr};

}  // namespace

CALX_PLUGIN(MyPlugin)
