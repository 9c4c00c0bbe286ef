// A box without a lid that does not say so, and one triangle of it wound the wrong way.
#include <calx/shape.hpp>

namespace {

const calx_field fields[] = {{"size", "m", "edge", 1e-6, 1e3, 0.1, 0, 0},
                             {"fault", "lid|winding", "what is wrong", 0, 1, 0, CALX_FIELD_CHOICE, 0}};

class OpenMesh : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  OpenMesh(const calx_host*, const calx_config& c) : size_(c.value[0]), winding_(c.value[1] > 0.5) {}
  calx_status send(const calx_shape_sink* sink) const override {
    calx::shape::Triangles all;
    for (int n = 0; n < 8; ++n) all.corner(n & 1 ? size_ : 0, n & 2 ? size_ : 0, n & 4 ? size_ : 0);
    all.quad(0, 2, 3, 1);
    if (winding_) all.quad(4, 6, 7, 5);
    all.quad(0, 1, 5, 4);
    all.quad(2, 6, 7, 3);
    all.quad(0, 4, 6, 2);
    all.quad(1, 3, 7, 5);
    return all.send(sink);
  }

 private:
  double size_;
  bool winding_;
};
const calx_descriptor OpenMesh::descriptor = calx::shape::descriptor("test.open-mesh", "Open mesh", "1.0.0", "Calx",
                                                                     "Apache-2.0", "A plugin for tests.", fields);

}  // namespace

CALX_PLUGIN(OpenMesh)
