// hopper.cpp: a conical hopper below a cylinder, calx.hopper, as one surface of revolution about a vertical axis.
#include <calx/shape.hpp>

namespace {

// Presets are the assumed dimensions of the reference process (assumption: its publication gives none).
const calx_field fields[] = {
    {"position_x", "m", "middle of the outlet, x (assumption: above the rotary valve)", -1e6, 1e6, 0.0577, CALX_VEC(1),
     0},
    {"position_y", "m", "middle of the outlet, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the outlet, z (assumption)", -1e6, 1e6, 0.670, CALX_VEC(1), 0},
    {"bore_radius", "m", "radius of the outlet (assumption: DN50)", 0, 1e6, 0.025, 0, 0},
    {"top_radius", "m", "radius of the cylinder (assumption)", 1e-9, 1e6, 0.1, 0, 0},
    {"cone_height", "m", "height of the cone; the preset makes its half angle 25.1 degrees (assumption)", 0, 1e6, 0.160,
     0, 0},
    {"cylinder_height", "m", "height of the cylinder above the cone (assumption)", 0, 1e6, 0.170, 0, 0}};

class Hopper : public calx::shape::Revolved {
 public:
  static const calx_descriptor descriptor;

  Hopper(const calx_host*, const calx_config& c) : Revolved(descriptor, c) {
    const double bore = calx::parameter(descriptor, c, "bore_radius"),
                 top = calx::parameter(descriptor, c, "top_radius");
    const double cone = calx::parameter(descriptor, c, "cone_height");
    const double cylinder = calx::parameter(descriptor, c, "cylinder_height");
    if (bore > top)
      throw calx::ConfigError("bore_radius: " + std::to_string(bore) + " m is larger than top_radius = " +
                              std::to_string(top) + " m; a hopper narrows downwards");
    if (!(cone > 0) && !(cylinder > 0))
      throw calx::ConfigError("cone_height and cylinder_height: both are 0; give the hopper some height");
    // Without a cone a floor remains between bore and cylinder; with equal radii the cone is a cylinder.
    if (cone > 0 || bore < top) add(bore, 0);
    add(top, cone);
    if (cylinder > 0) add(top, cone + cylinder);
  }
};

const calx_descriptor Hopper::descriptor = calx::shape::descriptor(
    "calx.hopper", "Hopper", "1.0.0", "Calx", "Apache-2.0", "A conical hopper with a cylinder on top, smooth.", fields);

}  // namespace

CALX_PLUGIN(Hopper)
