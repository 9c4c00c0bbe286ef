// canister.cpp: the canister that is filled, calx.canister, as one surface of revolution: floor, wall, and a lid with
// the port's hole.
#include <calx/plugin.hpp>
#include <vector>

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

class Canister : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  Canister(const calx_host*, const calx_config& c) {
    for (int k = 0; k < 3; ++k) position_[k] = calx::parameter(descriptor, c, position_names[k]);
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

  const void* get_interface(const char* id) const override {
    static const calx_geometry table = {sizeof(calx_geometry), CALX_ABI_DRAFT, &build};
    return std::strcmp(id, CALX_GEOMETRY) == 0 ? &table : 0;
  }

 private:
  static const char* const position_names[3];

  static calx_status CALX_CALL build(const calx_instance* instance, const calx_host*,
                                     const calx_shape_sink* sink) noexcept {
    const Canister& self = *static_cast<const Canister*>(instance);
    const double up[3] = {0, 0, 1};
    return sink->revolution(sink, self.position_, up, self.profile_.size() / 2, self.profile_.data(), 0);
  }

  void add(double r, double z) {
    profile_.push_back(r);
    profile_.push_back(z);
  }

  double position_[3];
  std::vector<double> profile_;  // (r, z) pairs from the middle of the floor round to the lid, z from position, m
};

const char* const Canister::position_names[3] = {"position_x", "position_y", "position_z"};

const calx_descriptor Canister::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "calx.canister",
                                              CALX_GEOMETRY,
                                              "Canister",
                                              "1.0.0",
                                              "Calx",
                                              "Apache-2.0",
                                              "A round canister with floor and lid, smooth.",
                                              0,
                                              fields,
                                              sizeof fields / sizeof fields[0],
                                              0,
                                              0};

}  // namespace

CALX_PLUGIN(Canister)
