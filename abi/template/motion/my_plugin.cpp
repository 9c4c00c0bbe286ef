// my_plugin.cpp: a turn about an axis that starts smoothly, the motion org.example.my-plugin.
#include <calx/rigid_motion.hpp>
#include <limits>

namespace {

using calx::rigid::Motion;
using calx::rigid::Vector;

// name, unit, meaning, lowest, highest, preset, flags, 0. An angle in rad may be written in degrees: speed_deg.
const calx_field fields[] = {
    CALX_VECTOR_FIELDS("origin", "m", 1e6, 0, 0, 0, 1, "a point of the axis"),
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 0, 1, 2, "direction of the axis, of any length"),
    {"speed", "rad/s", "speed after the start", -1e4, 1e4, 1, 0, 0},
    {"start", "s", "time from rest to full speed", 1e-6, 1e9, 0.1, 0, 0}};

class MyPlugin : public Motion {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host* host, const calx_config& c)
      : Motion(host),
        origin_(calx::rigid::vector(descriptor, c, "origin")),
        axis_(calx::rigid::direction(descriptor, c, "axis")),
        speed_(calx::parameter(descriptor, c, "speed")),
        start_(calx::parameter(descriptor, c, "start")) {}

  // Angle and its exact derivative at time t, s, since the start event; at rest for t <= 0.
  void pose(double t, calx_pose& out) const noexcept override {
    double angle = 0, rate = 0;
    if (t >= start_) {
      angle = speed_ * (t - 0.5 * start_);
      rate = speed_;
    } else if (t > 0) {
      angle = 0.5 * speed_ * t * t / start_;
      rate = speed_ * t / start_;
    }
    calx::rigid::turn(out, origin_, axis_, angle, rate);
    out.cycle = std::fabs(angle) / (2 * calx::rigid::pi);
  }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  double top_speed(double radius) const noexcept override { return radius * std::fabs(speed_); }

 private:
  Vector origin_, axis_;
  double speed_, start_;
};

const calx_descriptor MyPlugin::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "org.example.my-plugin",
                                              CALX_MOTION,
                                              "my-plugin",
                                              "0.1.0",
                                              "Example",
                                              "MIT",
                                              "Turns at a constant speed after a smooth start.",
                                              nullptr,
                                              fields,
                                              sizeof fields / sizeof fields[0],
                                              0,
                                              nullptr};

}  // namespace

CALX_PLUGIN(MyPlugin)
