// false_floor.cpp: a disc that lifts the bottom of a vessel, calx.false-floor, so that an overfill needs few grains.
#include <calx/plugin.hpp>
#include <vector>

namespace {

// Presets are the assumed dimensions of the reference process (assumption: its publication gives none).
const calx_field fields[] = {
    {"position_x", "m", "middle of the upper face, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the upper face, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the upper face, z (assumption: 25 mm below the lid)", -1e6, 1e6, 0.235, CALX_VEC(1),
     0},
    {"radius", "m", "radius of the disc (assumption: that of the canister)", 1e-9, 1e6, 0.1, 0, 0},
    {"thickness", "m", "0 for a sheet; else the disc has a lower face this far below, and a rim", 0, 1e6, 0, 0, 0}};

class FalseFloor : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  FalseFloor(const calx_host*, const calx_config& c) {
    for (int k = 0; k < 3; ++k) position_[k] = calx::parameter(descriptor, c, position_names[k]);
    const double radius = calx::parameter(descriptor, c, "radius");
    const double thickness = calx::parameter(descriptor, c, "thickness");
    if (thickness > 0) {
      add(0, -thickness);
      add(radius, -thickness);
    }
    add(radius, 0);
    add(0, 0);
  }

  const void* get_interface(const char* id) const override {
    static const calx_geometry table = {sizeof(calx_geometry), CALX_ABI_DRAFT, &build};
    return std::strcmp(id, CALX_GEOMETRY) == 0 ? &table : 0;
  }

 private:
  static const char* const position_names[3];

  static calx_status CALX_CALL build(const calx_instance* instance, const calx_host*,
                                     const calx_shape_sink* sink) noexcept {
    const FalseFloor& self = *static_cast<const FalseFloor*>(instance);
    const double up[3] = {0, 0, 1};
    return sink->revolution(sink, self.position_, up, self.profile_.size() / 2, self.profile_.data(), 0);
  }

  void add(double r, double z) {
    profile_.push_back(r);
    profile_.push_back(z);
  }

  double position_[3];
  std::vector<double> profile_;  // (r, z) pairs, z from position, m
};

const char* const FalseFloor::position_names[3] = {"position_x", "position_y", "position_z"};

const calx_descriptor FalseFloor::descriptor = {sizeof(calx_descriptor),
                                                0,
                                                "calx.false-floor",
                                                CALX_GEOMETRY,
                                                "False floor",
                                                "1.0.0",
                                                "Calx",
                                                "Apache-2.0",
                                                "A round disc that lifts the bottom of a vessel.",
                                                0,
                                                fields,
                                                sizeof fields / sizeof fields[0],
                                                0,
                                                0};

}  // namespace

CALX_PLUGIN(FalseFloor)
