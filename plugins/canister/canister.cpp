// canister.cpp: the canister that is filled, calx.canister, as one surface of revolution: floor, wall, and a lid with
// the port's hole.
#include <calx/shape.hpp>

namespace {

// Presets are the assumed dimensions of the reference process (assumption: its publication gives none).
const calx_field fields[] = {
    {"position_x", "m", "middle of the inner floor, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the inner floor, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the inner floor, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"radius", "m", "inner radius (assumption)", 1e-9, 1e6, 0.1, 0, 0},
    {"height", "m", "inner height, floor to lid (assumption)", 1e-9, 1e6, 0.260, 0, 0},
    {"lid", "none|closed|port", "no lid, a whole lid, or one with a round hole for the port", 0, 2, 2,
     CALX_FIELD_CHOICE, 0},
    {"port_radius", "m", "radius of the hole in the lid, for lid \"port\" (assumption: bore 36 mm)", 1e-9, 1e6, 0.018,
     0, 0}};

class Canister : public calx::shape::Revolved {
 public:
  static const calx_descriptor descriptor;

  Canister(const calx_host*, const calx_config& c) : Revolved(descriptor, c) {
    const double radius = calx::parameter(descriptor, c, "radius"), height = calx::parameter(descriptor, c, "height");
    const double port = calx::parameter(descriptor, c, "port_radius");
    const int lid = static_cast<int>(calx::parameter(descriptor, c, "lid"));
    if (lid == 2 && port >= radius)
      throw calx::ConfigError("port_radius: " + std::to_string(port) + " m leaves no lid within radius = " +
                              std::to_string(radius) + " m; give a smaller hole, or lid \"none\"");
    add(0, 0);
    add(radius, 0);
    add(radius, height);
    if (lid == 1) add(0, height);
    if (lid == 2) add(port, height);
  }
};

const calx_descriptor Canister::descriptor = calx::shape::descriptor(
    "calx.canister", "Canister", "1.0.0", "Calx", "Apache-2.0", "A round canister with floor and lid, smooth.", fields);

}  // namespace

CALX_PLUGIN(Canister)
