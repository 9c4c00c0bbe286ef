// lip_chute.cpp: an inclined chute with side walls and a lip across its lower end, the shape org.example.lip-chute. The
// frame is that of the world before any motion. It runs down towards +x.
#include <calx/shape.hpp>
#include <cmath>

namespace {

// name, unit, meaning, lowest, highest, preset, flags, 0. Users write lengths as they like; here all is SI.
const calx_field fields[] = {
    {"position_x", "m", "middle of the upper edge of the floor, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the upper edge of the floor, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the upper edge of the floor, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"inclination", "rad", "slope of the floor against the horizontal", 0, 1.57, 0.5236, 0, 0},
    {"length", "m", "along the slope", 1e-6, 1e6, 0.2, 0, 0},
    {"width", "m", "between the side walls, along y", 1e-6, 1e6, 0.05, 0, 0},
    {"side", "m", "height of the side walls, normal to the floor", 1e-6, 1e6, 0.03, 0, 0},
    {"lip", "m", "height of the lip, normal to the floor", 1e-6, 1e6, 0.005, 0, 0}};

class LipChute : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  LipChute(const calx_host*, const calx_config& c) {
    const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
    calx::shape::read_vector(descriptor, c, "position", at_);
    angle_ = get("inclination");
    length_ = get("length");
    width_ = get("width");
    side_ = get("side");
    lip_ = get("lip");
    if (lip_ > side_)
      throw calx::ConfigError("lip: it is higher than side; grains would leave over the side walls first");
  }

  calx_status send(const calx_shape_sink* sink) const override {
    calx::shape::Triangles all;
    // Along the slope, across, normal to the floor.
    const auto corner = [&](double along, double across, double above) {
      return all.corner(at_[0] + along * std::cos(angle_) + above * std::sin(angle_), at_[1] + across,
                        at_[2] - along * std::sin(angle_) + above * std::cos(angle_));
    };
    const double half = 0.5 * width_;
    uint32_t floor[2][2], top[2][2], lip[2];  // [upper, lower end][right, left: -y, +y]
    for (int end = 0; end < 2; ++end)
      for (int left = 0; left < 2; ++left) {
        floor[end][left] = corner(end * length_, left ? half : -half, 0);
        top[end][left] = corner(end * length_, left ? half : -half, side_);
      }
    for (int left = 0; left < 2; ++left)
      lip[left] = lip_ < side_ ? corner(length_, left ? half : -half, lip_) : top[1][left];
    // Counter-clockwise seen from the powder.
    all.quad(floor[0][0], floor[1][0], floor[1][1], floor[0][1]);
    all.quad(floor[1][0], lip[0], lip[1], floor[1][1]);
    // A side wall shares the lip's upper corner, so that edges meet.
    all.triangle(floor[0][0], top[0][0], top[1][0]);
    all.triangle(floor[0][0], top[1][0], lip[0]);
    all.triangle(floor[0][0], lip[0], floor[1][0]);
    all.triangle(floor[0][1], top[1][1], top[0][1]);
    all.triangle(floor[0][1], lip[1], top[1][1]);
    all.triangle(floor[0][1], floor[1][1], lip[1]);
    return all.send(sink);
  }

 private:
  double at_[3], angle_, length_, width_, side_, lip_;
};

const calx_descriptor LipChute::descriptor =
    calx::shape::descriptor("org.example.lip-chute", "lip-chute", "0.1.0", "Example", "MIT",
                            "An inclined chute with side walls and a lip across its lower end.", fields);

}  // namespace

CALX_PLUGIN(LipChute)
