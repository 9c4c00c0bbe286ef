// false_floor.cpp: a disc that lifts the bottom of a vessel, calx.false-floor, so that an overfill needs few grains.
#include <calx/shape.hpp>

namespace {

// Presets are the assumed dimensions of the reference process (assumption: its publication gives none).
const calx_field fields[] = {
    {"position_x", "m", "middle of the upper face, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the upper face, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the upper face, z (assumption: 25 mm below the lid)", -1e6, 1e6, 0.235, CALX_VEC(1),
     0},
    {"radius", "m", "radius of the disc (assumption: that of the canister)", 1e-9, 1e6, 0.1, 0, 0},
    {"thickness", "m", "0 for a sheet; else the disc has a lower face this far below, and a rim", 0, 1e6, 0, 0, 0}};

class FalseFloor : public calx::shape::Revolved {
 public:
  static const calx_descriptor descriptor;

  FalseFloor(const calx_host*, const calx_config& c) : Revolved(descriptor, c) {
    const double radius = calx::parameter(descriptor, c, "radius");
    const double thickness = calx::parameter(descriptor, c, "thickness");
    if (thickness > 0) {
      add(0, -thickness);
      add(radius, -thickness);
    }
    add(radius, 0);
    add(0, 0);
  }
};

const calx_descriptor FalseFloor::descriptor =
    calx::shape::descriptor("calx.false-floor", "False floor", "1.0.0", "Calx", "Apache-2.0",
                            "A round disc that lifts the bottom of a vessel.", fields);

}  // namespace

CALX_PLUGIN(FalseFloor)
