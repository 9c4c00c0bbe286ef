// canister_tilt.cpp: calx.canister-tilt, a constant turn about a horizontal axis.
#include <calx/rigid_motion.hpp>

namespace {

const calx_field fields[] = {CALX_VECTOR_FIELDS("pivot", "m", 1e6, 0, 0, 0, 1, "point that stays in place"),
                             {"tilt", "rad", "angle of the axis from the vertical", -1.5, 1.5, 0, 0, 0},
                             {"azimuth", "rad", "direction of the lower side, from +x towards +y", -7, 7, 0, 0, 0}};

class CanisterTilt : public calx::rigid::Motion {
 public:
  static const calx_descriptor descriptor;

  CanisterTilt(const calx_host* host, const calx_config& c)
      : Motion(host),
        pivot_(calx::rigid::vector(descriptor, c, "pivot")),
        tilt_(calx::parameter(descriptor, c, "tilt")),
        azimuth_(calx::parameter(descriptor, c, "azimuth")) {}

  void pose(double, calx_pose& out) const noexcept override {
    // Without a tilt the pose of rest: turning about a pivot would round.
    if (!(std::fabs(tilt_) > 0)) return;
    const calx::rigid::Vector axis = {-std::sin(azimuth_), std::cos(azimuth_), 0};
    calx::rigid::turn(out, pivot_, axis, tilt_, 0);
    out.angle = 0;
  }
  double duration() const noexcept override { return 0; }
  double top_speed(double) const noexcept override { return 0; }

 private:
  calx::rigid::Vector pivot_;
  double tilt_, azimuth_;
};

const calx_descriptor CanisterTilt::descriptor = {sizeof(calx_descriptor),
                                                  0,
                                                  "calx.canister-tilt",
                                                  CALX_MOTION,
                                                  "Tilted canister",
                                                  "1.0.0",
                                                  "Calx",
                                                  "Apache-2.0",
                                                  "A canister that stands tilted about a horizontal axis.",
                                                  0,
                                                  fields,
                                                  sizeof fields / sizeof fields[0],
                                                  0,
                                                  0};

}  // namespace

CALX_PLUGIN(CanisterTilt)
