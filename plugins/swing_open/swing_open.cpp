// swing_open.cpp: one rotation from an angle to another, calx.open-close: butterfly valve, swing gate, flap.
#include <calx/rigid_motion.hpp>

namespace {

using calx::rigid::Motion;
using calx::rigid::Progress;
using calx::rigid::Trip;
using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("origin", "m", 1e6, 0, 0, 0, 1, "a point of the axis of rotation"),
    CALX_VECTOR_FIELDS("axis", "1", 1e6, 0, 1, 0, 2, "direction of the axis of rotation, of any length"),
    {"angle_from", "rad", "angle at rest before the start, right-handed about the axis; 0: as the part is drawn", -1e4,
     1e4, 0, 0, 0},
    {"angle_to", "rad", "angle after the way", -1e4, 1e4, 0.5 * calx::rigid::pi, 0, 0},
    {"duration", "s", "time of one way", 1e-6, 1e9, 0.5, 0, 0},
    CALX_TRIP_FIELDS};

class SwingOpen : public Motion {
 public:
  static const calx_descriptor descriptor;

  SwingOpen(const calx_host* host, const calx_config& c)
      : Motion(host),
        origin_(calx::rigid::vector(descriptor, c, "origin")),
        axis_(calx::rigid::direction(descriptor, c, "axis")),
        from_(calx::parameter(descriptor, c, "angle_from")),
        to_(calx::parameter(descriptor, c, "angle_to")),
        trip_(calx::rigid::single_trip(descriptor, c)) {}

  void pose(double t, calx_pose& out) const noexcept override {
    const Progress p = trip_.after_start(t);
    // Both ends exactly: a shut valve must stand at its own angle, not a rounding away from it.
    const double angle = p.value <= 0 ? from_ : p.value >= 1 ? to_ : from_ + (to_ - from_) * p.value;
    calx::rigid::turn(out, origin_, axis_, angle, (to_ - from_) * p.rate);
  }
  double duration() const noexcept override { return trip_.end(); }
  double top_speed(double radius) const noexcept override {
    return std::fabs(to_ - from_) / trip_.time * trip_.peak() * radius;
  }

 private:
  Vector origin_, axis_;
  double from_, to_;
  Trip trip_;
};

const calx_descriptor SwingOpen::descriptor = {sizeof(calx_descriptor),
                                               0,
                                               "calx.open-close",
                                               CALX_MOTION,
                                               "Opening and closing rotation",
                                               "1.0.0",
                                               "Calx",
                                               "Apache-2.0",
                                               "Turns once from one angle to another, and back if wanted.",
                                               0,
                                               fields,
                                               sizeof fields / sizeof fields[0],
                                               0,
                                               0};

}  // namespace

CALX_PLUGIN(SwingOpen)
