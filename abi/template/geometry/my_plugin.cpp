// my_plugin.cpp: a flat plate, the shape org.example.my-plugin. The frame is that of the world before any motion.
#include <calx/shape.hpp>

namespace {

// name, unit, meaning, lowest, highest, preset, flags, 0. Users write lengths as they like; here all is SI.
const calx_field fields[] = {
    {"corner_x", "m", "lowest corner, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"corner_y", "m", "lowest corner, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"corner_z", "m", "lowest corner, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"length", "m", "size along x", 1e-6, 1e6, 0.1, 0, 0},
    {"width", "m", "size along y", 1e-6, 1e6, 0.1, 0, 0},
    {"thickness", "m", "size along z", 1e-6, 1e6, 0.002, 0, 0}};

class MyPlugin : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host*, const calx_config& c) {
    const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
    low_[0] = get("corner_x");
    low_[1] = get("corner_y");
    low_[2] = get("corner_z");
    size_[0] = get("length");
    size_[1] = get("width");
    size_[2] = get("thickness");
    if (size_[2] > size_[0])
      throw calx::ConfigError("thickness: it is larger than length; a plate is thinner than it is long");
  }

  calx_status send(const calx_shape_sink* sink) const override {
    calx::shape::Triangles all;
    // Corner number: bit 0 along x, bit 1 along y, bit 2 along z.
    for (int n = 0; n < 8; ++n)
      all.corner(low_[0] + (n & 1 ? size_[0] : 0), low_[1] + (n & 2 ? size_[1] : 0), low_[2] + (n & 4 ? size_[2] : 0));
    // Counter-clockwise seen from outside, so that normals point outwards.
    all.quad(0, 2, 3, 1);
    all.quad(4, 5, 7, 6);
    all.quad(0, 1, 5, 4);
    all.quad(2, 6, 7, 3);
    all.quad(0, 4, 6, 2);
    all.quad(1, 3, 7, 5);
    return all.send(sink);
  }

 private:
  double low_[3], size_[3];
};

const calx_descriptor MyPlugin::descriptor = calx::shape::descriptor(
    "org.example.my-plugin", "my-plugin", "0.1.0", "Example", "MIT", "A flat plate with a thickness.", fields);

}  // namespace

CALX_PLUGIN(MyPlugin)
