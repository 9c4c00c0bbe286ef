// reciprocate.cpp: to-and-fro rotation with dwell, calx.reciprocate: the rotor of a valve that turns by +-180 degrees.
#include <calx/rigid_motion.hpp>
#include <limits>

namespace {

using calx::rigid::Motion;
using calx::rigid::Progress;
using calx::rigid::Trip;
using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("origin", "m", 1e6, 0, 0, 0, 1, "a point of the axis of rotation"),
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 1, 0, 2, "direction of the axis of rotation, of any length"),
    {"swing", "rad", "angle of the first stroke, right-handed about the axis; negative: the other way first", -1e4, 1e4,
     calx::rigid::pi, 0, 0},
    {"stroke", "s", "time of one stroke", 1e-6, 1e9, 0.2, 0, 0},
    {"dwell", "s", "rest after each stroke", 0, 1e9, 0.08, 0, 0},
    {"cycles", "1", "number of cycles (stroke, dwell, stroke back, dwell); 0: endless", 0, 1e9, 0, CALX_FIELD_INTEGER,
     0},
    CALX_PROFILE_FIELDS};

class Reciprocate : public Motion {
 public:
  static const calx_descriptor descriptor;

  Reciprocate(const calx_host* host, const calx_config& c)
      : Motion(host),
        origin_(calx::rigid::vector(descriptor, c, "origin")),
        axis_(calx::rigid::direction(descriptor, c, "axis")),
        swing_(calx::parameter(descriptor, c, "swing")),
        cycles_(calx::parameter(descriptor, c, "cycles")),
        trip_(calx::rigid::trip(descriptor, c, calx::parameter(descriptor, c, "stroke"),
                                calx::parameter(descriptor, c, "dwell"), true)),
        period_(trip_.end() + trip_.hold) {}

  void pose(double t, calx_pose& out) const noexcept override {
    Progress p = {0, 0};
    if (t >= duration()) {
      out.cycle = cycles_;
    } else if (t > 0) {
      // fmod is exact, so whole periods drop out without rounding; a division would not do that.
      const double phase = std::fmod(t, period_);
      p = trip_.at(phase);
      out.cycle = std::floor((t - phase) / period_ + 0.5) + phase / period_;
    }
    calx::rigid::turn(out, origin_, axis_, swing_ * p.value, swing_ * p.rate);
  }
  double duration() const noexcept override {
    return cycles_ > 0 ? cycles_ * period_ : std::numeric_limits<double>::infinity();
  }
  double top_speed(double radius) const noexcept override {
    return std::fabs(swing_) / trip_.time * trip_.peak() * radius;
  }

 private:
  Vector origin_, axis_;
  double swing_, cycles_;
  Trip trip_;
  double period_;
};

const calx_descriptor Reciprocate::descriptor = {sizeof(calx_descriptor),
                                                 0,
                                                 "calx.reciprocate",
                                                 CALX_MOTION,
                                                 "Reciprocating rotation",
                                                 "1.0.0",
                                                 "Calx",
                                                 "Apache-2.0",
                                                 "Turns to and fro about an axis, with a rest after each stroke.",
                                                 0,
                                                 fields,
                                                 sizeof fields / sizeof fields[0],
                                                 0,
                                                 0};

}  // namespace

CALX_PLUGIN(Reciprocate)
