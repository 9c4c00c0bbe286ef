// A motion whose velocity is not the derivative of its pose: half as fast.
#include <calx/rigid_motion.hpp>

#ifndef BAD_ID
#define BAD_ID "test.wrong-velocity"
#define BAD_SPEED 0.5
#endif

namespace {

class WrongVelocity : public calx::rigid::Motion {
 public:
  static const calx_descriptor descriptor;
  WrongVelocity(const calx_host* host, const calx_config&) : Motion(host) {}
  void pose(double t, calx_pose& out) const noexcept override {
    if (!(t > 0)) return;
    const double end = t < 1 ? t : 1;
    out.displacement[0] = end;
    out.velocity[0] = t < 1 ? BAD_SPEED : 0;
  }
  double duration() const noexcept override { return 1; }
  double top_speed(double) const noexcept override { return 1; }
};
const calx_descriptor WrongVelocity::descriptor = {sizeof(calx_descriptor),
                                                   0,
                                                   BAD_ID,
                                                   CALX_MOTION,
                                                   "Wrong velocity",
                                                   "1.0.0",
                                                   "Calx",
                                                   "Apache-2.0",
                                                   "A plugin for tests.",
                                                   0,
                                                   0,
                                                   0,
                                                   0,
                                                   0};

}  // namespace

CALX_PLUGIN(WrongVelocity)
