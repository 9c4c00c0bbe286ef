// vibration.cpp: harmonic displacement, calx.vibration: vibratory compaction, a shaken sieve.
#include <calx/rigid_motion.hpp>
#include <limits>

namespace {

using calx::rigid::Motion;
using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("direction", "1", 1e6, 0, 0, 1, 1, "direction of the vibration, of any length"),
    {"amplitude", "m", "largest displacement, half of the peak-to-peak value", 0, 1e3, 0.0005, 0, 0},
    {"frequency", "1/s", "oscillations per second", 1e-6, 1e6, 50, 0, 0},
    {"phase", "rad", "phase at the start; without a ramp the part rests at amplitude * sin(phase) before it", -1e4, 1e4,
     0, 0, 0},
    {"duration", "s", "time from start to end; 0: endless", 0, 1e9, 0, 0, 0},
    {"ramp", "s", "time over which the amplitude rises after the start, and falls before the end of a duration", 0, 1e9,
     0, 0, 0}};

class Vibration : public Motion {
 public:
  static const calx_descriptor descriptor;

  Vibration(const calx_host* host, const calx_config& c)
      : Motion(host),
        direction_(calx::rigid::direction(descriptor, c, "direction")),
        amplitude_(calx::parameter(descriptor, c, "amplitude")),
        frequency_(calx::parameter(descriptor, c, "frequency")),
        phase_(calx::parameter(descriptor, c, "phase")),
        duration_(calx::parameter(descriptor, c, "duration")),
        ramp_(calx::parameter(descriptor, c, "ramp")) {
    if (duration_ > 0 && 2 * ramp_ > duration_)
      throw calx::ConfigError("ramp: " + calx::rigid::number(ramp_) + " s, twice, is longer than the duration " +
                              calx::rigid::number(duration_) + " s; it can be half of the duration at most");
  }

  // x = a e(t) sin(2 pi f t + phase), e the envelope; v = a (e' sin + 2 pi f e cos).
  void pose(double t, calx_pose& out) const noexcept override {
    const double end = duration(), time = t > end ? end : t > 0 ? t : 0;
    double envelope = 1, slope = 0;
    if (ramp_ > 0 && time < ramp_) {
      envelope = time / ramp_;
      slope = 1 / ramp_;
    } else if (ramp_ > 0 && end - time < ramp_) {
      envelope = (end - time) / ramp_;
      slope = -1 / ramp_;
    }
    // Whole oscillations are taken off before 2 pi multiplies their rounding.
    const double turns = frequency_ * time;
    const double omega = 2 * calx::rigid::pi * frequency_;
    const double angle = 2 * calx::rigid::pi * (turns - std::floor(turns)) + phase_;
    calx::rigid::set(out.displacement, direction_, amplitude_ * envelope * std::sin(angle));
    if (t > 0 && t < end)
      calx::rigid::set(out.velocity, direction_,
                       amplitude_ * (slope * std::sin(angle) + omega * envelope * std::cos(angle)));
    out.cycle = turns;
  }
  double duration() const noexcept override {
    return duration_ > 0 ? duration_ : std::numeric_limits<double>::infinity();
  }
  // |v| <= a sqrt(omega^2 e^2 + e'^2) <= a sqrt(omega^2 + 1 / ramp^2).
  double top_speed(double) const noexcept override {
    const double omega = 2 * calx::rigid::pi * frequency_, slope = ramp_ > 0 ? 1 / ramp_ : 0;
    return amplitude_ * std::sqrt(omega * omega + slope * slope);
  }

 private:
  Vector direction_;
  double amplitude_, frequency_, phase_, duration_, ramp_;
};

const calx_descriptor Vibration::descriptor = {sizeof(calx_descriptor),
                                               0,
                                               "calx.vibration",
                                               CALX_MOTION,
                                               "Vibration",
                                               "1.0.0",
                                               "Calx",
                                               "Apache-2.0",
                                               "Displaces harmonically along a direction.",
                                               0,
                                               fields,
                                               sizeof fields / sizeof fields[0],
                                               0,
                                               0};

}  // namespace

CALX_PLUGIN(Vibration)
