// box.cpp: an axis-parallel box, calx.box: a bin, a rig, a duct. Faces can be left open.
#include <calx/plugin.hpp>
#include <vector>

namespace {

const calx_field fields[] = {
    {"min_x", "m", "lowest corner, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"min_y", "m", "lowest corner, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"min_z", "m", "lowest corner, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"max_x", "m", "highest corner, x", -1e6, 1e6, 1, CALX_VEC(2), 0},
    {"max_y", "m", "highest corner, y", -1e6, 1e6, 1, CALX_VEC(2), 0},
    {"max_z", "m", "highest corner, z", -1e6, 1e6, 1, CALX_VEC(2), 0},
    {"open_left", "no|yes", "leaves out the face of lowest x", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"open_right", "no|yes", "leaves out the face of highest x", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"open_front", "no|yes", "leaves out the face of lowest y", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"open_back", "no|yes", "leaves out the face of highest y", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"open_bottom", "no|yes", "leaves out the face of lowest z", 0, 1, 0, CALX_FIELD_CHOICE, 0},
    {"open_top", "no|yes", "leaves out the face of highest z", 0, 1, 0, CALX_FIELD_CHOICE, 0}};

// Corner k has the high coordinate along axis b where bit b of k is set. Faces in the order of the open_ fields,
// counter-clockwise seen from outside.
const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

class Box : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  Box(const calx_host*, const calx_config& c) {
    bool any = false;
    for (int f = 0; f < 6; ++f) {
      open_[f] = c.value[6 + f] > 0.5;
      any = any || !open_[f];
    }
    if (!any) throw calx::ConfigError("open_left to open_top: all six faces are open; leave at least one closed");
    for (int k = 0; k < 3; ++k) {
      lo_[k] = c.value[k];
      hi_[k] = c.value[3 + k];
      if (!(lo_[k] < hi_[k]))
        throw calx::ConfigError(std::string("min and max: along ") + "xyz"[k] + " min = " + std::to_string(lo_[k]) +
                                " m is not below max = " + std::to_string(hi_[k]) + " m");
    }
  }

  const void* get_interface(const char* id) const override {
    static const calx_geometry table = {sizeof(calx_geometry), CALX_ABI_DRAFT, &build};
    return std::strcmp(id, CALX_GEOMETRY) == 0 ? &table : 0;
  }

 private:
  static calx_status CALX_CALL build(const calx_instance* instance, const calx_host*,
                                     const calx_shape_sink* sink) noexcept {
    const Box& self = *static_cast<const Box*>(instance);
    double xyz[24];
    for (int corner = 0; corner < 8; ++corner)
      for (int k = 0; k < 3; ++k) xyz[3 * corner + k] = (corner >> k) & 1 ? self.hi_[k] : self.lo_[k];
    uint32_t index[36];
    uint64_t count = 0;
    for (int f = 0; f < 6; ++f) {
      if (self.open_[f]) continue;
      const uint32_t* q = faces[f];
      const uint32_t two[] = {q[0], q[1], q[2], q[0], q[2], q[3]};
      for (int k = 0; k < 6; ++k) index[3 * count + k] = two[k];
      count += 2;
    }
    return sink->triangles(sink, 8, xyz, count, index);
  }

  double lo_[3], hi_[3];
  bool open_[6];
};

const calx_descriptor Box::descriptor = {sizeof(calx_descriptor),
                                         0,
                                         "calx.box",
                                         CALX_GEOMETRY,
                                         "Box",
                                         "1.0.0",
                                         "Calx",
                                         "Apache-2.0",
                                         "A box whose faces can be left open.",
                                         0,
                                         fields,
                                         sizeof fields / sizeof fields[0],
                                         0,
                                         0};

}  // namespace

CALX_PLUGIN(Box)
