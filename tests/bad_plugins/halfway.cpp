// A plate of one square beside two half as wide, so that a corner lies halfway on an edge.
#include <calx/shape.hpp>

namespace {

const calx_field fields[] = {{"size", "m", "edge", 1e-6, 1e3, 1, 0, 0}};

class Halfway : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  Halfway(const calx_host*, const calx_config& c) : a_(c.value[0]) {}
  calx_status send(const calx_shape_sink* sink) const override {
    calx::shape::Triangles all;
    const double at[8][2] = {{-1, 0}, {0, 0}, {0, 1}, {-1, 1}, {1, 0}, {1, 0.5}, {0, 0.5}, {1, 1}};
    for (const auto& p : at) all.corner(a_ * p[0], a_ * p[1], 0);
    all.quad(0, 1, 2, 3);
    all.quad(1, 4, 5, 6);
    all.quad(6, 5, 7, 2);
    return all.send(sink);
  }

 private:
  double a_;
};
const calx_descriptor Halfway::descriptor =
    calx::shape::descriptor("test.halfway", "Halfway", "1.0.0", "Calx", "Apache-2.0", "A plugin for tests.", fields);

}  // namespace

CALX_PLUGIN(Halfway)
