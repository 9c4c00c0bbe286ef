// centroid.cpp: mass-weighted centre of the particles in a box, calx.centroid: which side of a vessel fills first.
#include <calx/plugin.hpp>
#include <limits>

namespace {

const calx_field fields[] = {
    {"min_x", "m", "lowest corner of the box, world frame, x", -1e9, 1e9, -1e9, CALX_VEC(1), 0},
    {"min_y", "m", "lowest corner of the box, world frame, y", -1e9, 1e9, -1e9, CALX_VEC(1), 0},
    {"min_z", "m", "lowest corner of the box, world frame, z", -1e9, 1e9, -1e9, CALX_VEC(1), 0},
    {"max_x", "m", "highest corner of the box, world frame, x", -1e9, 1e9, 1e9, CALX_VEC(2), 0},
    {"max_y", "m", "highest corner of the box, world frame, y", -1e9, 1e9, 1e9, CALX_VEC(2), 0},
    {"max_z", "m", "highest corner of the box, world frame, z", -1e9, 1e9, 1e9, CALX_VEC(2), 0}};

const calx_field outputs[] = {
    {"x", "m", "centre of mass, x; not a number while the box is empty", -1e9, 1e9, 0, CALX_VEC(1), 0},
    {"y", "m", "centre of mass, y; not a number while the box is empty", -1e9, 1e9, 0, CALX_VEC(1), 0},
    {"z", "m", "centre of mass, z; not a number while the box is empty", -1e9, 1e9, 0, CALX_VEC(1), 0},
    {"mass", "kg", "mass of the particles whose centres lie in the box", 0, 1e12, 0, 0, 0}};

class Centroid : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  Centroid(const calx_host*, const calx_config& c) {
    const char* const axes[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) {
      const std::string low = std::string("min_") + axes[k], high = std::string("max_") + axes[k];
      lo_[k] = calx::parameter(descriptor, c, low.c_str());
      hi_[k] = calx::parameter(descriptor, c, high.c_str());
      if (!(lo_[k] < hi_[k]))
        throw calx::ConfigError("min: its " + std::string(axes[k]) +
                                " is not below that of max, so the box has no inside; give min < max");
    }
  }

  const void* get_interface(const char* id) const override {
    static const calx_sensor table = {
        sizeof(calx_sensor), CALX_ABI_DRAFT, outputs, sizeof outputs / sizeof outputs[0], 0, &sample};
    return std::strcmp(id, CALX_SENSOR) == 0 ? &table : 0;
  }

 private:
  bool contains(double x, double y, double z) const {
    return x >= lo_[0] && x <= hi_[0] && y >= lo_[1] && y <= hi_[1] && z >= lo_[2] && z <= hi_[2];
  }
  // Sums in the order of rising id, so the same particles give the same bits whatever their order in memory.
  static calx_status CALX_CALL sample(calx_instance* instance, const calx_host*, const calx_sensor_view* v,
                                      double* out) noexcept {
    const Centroid& self = *static_cast<const Centroid*>(instance);
    double mass = 0, sum[3] = {0, 0, 0};
    for (uint64_t k = 0; k < v->count; ++k) {
      if (!self.contains(v->x[k], v->y[k], v->z[k])) continue;
      mass += v->mass[k];
      sum[0] += v->mass[k] * v->x[k];
      sum[1] += v->mass[k] * v->y[k];
      sum[2] += v->mass[k] * v->z[k];
    }
    for (int k = 0; k < 3; ++k) out[k] = mass > 0 ? sum[k] / mass : std::numeric_limits<double>::quiet_NaN();
    out[3] = mass;
    return CALX_OK;
  }

  double lo_[3], hi_[3];
};

const calx_descriptor Centroid::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "calx.centroid",
                                              CALX_SENSOR,
                                              "Centre of mass",
                                              "1.0.0",
                                              "Calx",
                                              "Apache-2.0",
                                              "Mass-weighted centre of the particles in a box.",
                                              0,
                                              fields,
                                              sizeof fields / sizeof fields[0],
                                              0,
                                              0};

}  // namespace

CALX_PLUGIN(Centroid)
