// travel.cpp: a straight displacement, calx.travel: lowering a canister, a slide gate, lifting a cylinder.
#include <calx/rigid_motion.hpp>

namespace {

using calx::rigid::Motion;
using calx::rigid::Progress;
using calx::rigid::Trip;
using calx::rigid::Vector;

const calx_field fields[] = {
    CALX_VECTOR_FIELDS("displacement", "m", 1e6, 0, 0, 0.01, 1, "way from the place as drawn to the other end"),
    {"duration", "s", "time of one way; 0: from speed, and 1 s where that is 0 too", 0, 1e9, 0, 0, 0},
    {"speed", "m/s", "largest speed on the way; 0: from duration", 0, 1e6, 0, 0, 0},
    CALX_TRIP_FIELDS};

class Travel : public Motion {
 public:
  static const calx_descriptor descriptor;

  Travel(const calx_host* host, const calx_config& c)
      : Motion(host),
        way_(calx::rigid::vector(descriptor, c, "displacement")),
        trip_(calx::rigid::single_trip(descriptor, c)) {
    const double speed = calx::parameter(descriptor, c, "speed");
    if (!(way_.length() > 0))
      throw calx::ConfigError("displacement: [0, 0, 0] is no way to go; give at least one component that is not 0");
    if (speed > 0 && trip_.time > 0)
      throw calx::ConfigError("speed: " + calx::rigid::number(speed) + " m/s and duration " +
                              calx::rigid::number(trip_.time) + " s are given both; give one of them");
    if (speed > 0)
      trip_.time = way_.length() * trip_.peak() / speed;
    else if (!(trip_.time > 0))
      trip_.time = 1;
  }

  void pose(double t, calx_pose& out) const noexcept override {
    const Progress p = trip_.after_start(t);
    calx::rigid::set(out.displacement, way_, p.value);
    calx::rigid::set(out.velocity, way_, p.rate);
  }
  double duration() const noexcept override { return trip_.end(); }
  double top_speed(double) const noexcept override { return way_.length() / trip_.time * trip_.peak(); }

 private:
  Vector way_;
  Trip trip_;
};

const calx_descriptor Travel::descriptor = {sizeof(calx_descriptor),
                                            0,
                                            "calx.travel",
                                            CALX_MOTION,
                                            "Straight travel",
                                            "1.0.0",
                                            "Calx",
                                            "Apache-2.0",
                                            "Moves once along a straight line, and back if wanted.",
                                            0,
                                            fields,
                                            sizeof fields / sizeof fields[0],
                                            0,
                                            0};

}  // namespace

CALX_PLUGIN(Travel)
