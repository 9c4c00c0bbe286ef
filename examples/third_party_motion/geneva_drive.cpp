// geneva_drive.cpp: a wheel indexed by an external Geneva drive, the motion org.example.geneva-drive. While the pin of
// the crank is in a slot, at crank angle a from the line of centres, the wheel stands at atan2(sin a, mu - cos a) from
// it, with mu = 1 / sin(pi / slots) the distance of the axes over the radius of the crank. Each turn of the crank turns
// the wheel by one slot and then holds it.
#include <calx/rigid_motion.hpp>
#include <limits>

namespace {

using calx::rigid::Motion;
using calx::rigid::pi;
using calx::rigid::Vector;

// name, unit, meaning, lowest, highest, preset, flags, 0.
const calx_field fields[] = {
    CALX_VECTOR_FIELDS("origin", "m", 1e6, 0, 0, 0, 1, "a point of the wheel's axis"),
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 0, 1, 2, "direction of the wheel's axis, of any length"),
    {"slots", "1", "slots of the wheel", 3, 1000, 4, CALX_FIELD_INTEGER, 0},
    {"crank_period", "s", "time of one turn of the crank", 1e-6, 1e9, 1, 0, 0},
    {"turns", "1", "turns of the crank before the drive stops; 0: it never does", 0, 1e9, 0, CALX_FIELD_INTEGER, 0}};

class GenevaDrive : public Motion {
 public:
  static const calx_descriptor descriptor;

  GenevaDrive(const calx_host* host, const calx_config& c)
      : Motion(host),
        origin_(calx::rigid::vector(descriptor, c, "origin")),
        axis_(calx::rigid::direction(descriptor, c, "axis")),
        slots_(calx::parameter(descriptor, c, "slots")),
        period_(calx::parameter(descriptor, c, "crank_period")),
        turns_(calx::parameter(descriptor, c, "turns")),
        mu_(1 / std::sin(pi / slots_)) {}

  // The pin enters a slot at t = 0, where the wheel's speed is zero, and leaves it at a = +engaged.
  void pose(double t, calx_pose& out) const noexcept override {
    double wheel = 0, rate = 0, turn = 0;
    if (t > 0) {
      const double engaged = 0.5 * pi - pi / slots_;  // rad, of the crank, to either side of the line of centres
      turn = t < duration() ? std::floor(t / period_) : turns_;
      const double a = 2 * pi * (t / period_ - turn) - engaged;
      wheel = 2 * pi / slots_ * turn;
      if (t < duration() && a < engaged) {
        wheel += pi / slots_ + std::atan2(std::sin(a), mu_ - std::cos(a));
        rate = 2 * pi / period_ * (mu_ * std::cos(a) - 1) / (1 + mu_ * mu_ - 2 * mu_ * std::cos(a));
      } else if (t < duration()) {
        wheel += 2 * pi / slots_;
      }
      out.cycle = t < duration() ? t / period_ : turns_;
    }
    calx::rigid::turn(out, origin_, axis_, wheel, rate);
  }
  double duration() const noexcept override {
    return turns_ > 0 ? turns_ * period_ : std::numeric_limits<double>::infinity();
  }
  // Fastest on the line of centres.
  double top_speed(double radius) const noexcept override { return radius * 2 * pi / period_ / (mu_ - 1); }

 private:
  Vector origin_, axis_;
  double slots_, period_, turns_, mu_;
};

const calx_descriptor GenevaDrive::descriptor = {sizeof(calx_descriptor),
                                                 0,
                                                 "org.example.geneva-drive",
                                                 CALX_MOTION,
                                                 "geneva-drive",
                                                 "0.1.0",
                                                 "Example",
                                                 "MIT",
                                                 "A wheel indexed by an external Geneva drive.",
                                                 nullptr,
                                                 fields,
                                                 sizeof fields / sizeof fields[0],
                                                 0,
                                                 nullptr};

}  // namespace

CALX_PLUGIN(GenevaDrive)
