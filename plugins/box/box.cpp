// box.cpp: an axis-parallel box, calx.box: a bin, a rig, a duct. Faces can be left open.
#include <calx/shape.hpp>

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

class Box : public calx::shape::Shape {
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

  calx_status send(const calx_shape_sink* sink) const override {
    calx::shape::Triangles all;
    for (int corner = 0; corner < 8; ++corner)
      all.corner(corner & 1 ? hi_[0] : lo_[0], corner & 2 ? hi_[1] : lo_[1], corner & 4 ? hi_[2] : lo_[2]);
    for (int f = 0; f < 6; ++f)
      if (!open_[f]) all.quad(faces[f][0], faces[f][1], faces[f][2], faces[f][3]);
    return all.send(sink);
  }

 private:
  double lo_[3], hi_[3];
  bool open_[6];
};

const calx_descriptor Box::descriptor = calx::shape::descriptor("calx.box", "Box", "1.0.0", "Calx", "Apache-2.0",
                                                                "A box whose faces can be left open.", fields);

}  // namespace

CALX_PLUGIN(Box)
