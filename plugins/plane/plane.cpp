// plane.cpp: a flat rectangle, calx.plane. Cut into more triangles it must act as the same wall; tests use that.
#include <calx/shape.hpp>
#include <cmath>

namespace {

const calx_field fields[] = {
    {"point_x", "m", "middle of the rectangle, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"point_y", "m", "middle of the rectangle, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"point_z", "m", "middle of the rectangle, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"normal_x", "1", "direction across the rectangle, of any length, x", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"normal_y", "1", "direction across the rectangle, of any length, y", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"normal_z", "1", "direction across the rectangle, of any length, z", -1e6, 1e6, 1, CALX_VEC(2), 0},
    {"half_u", "m", "half the side along u: the x axis laid into the plane, the y axis for a normal near x", 1e-9, 1e6,
     1, 0, 0},
    {"half_v", "m", "half the side along v = normal x u", 1e-9, 1e6, 1, 0, 0},
    {"divisions", "1", "cuts along each side: n gives 2 n^2 triangles of the same wall", 1, 1000, 1, CALX_FIELD_INTEGER,
     0}};

class Plane : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  Plane(const calx_host*, const calx_config& c)
      : half_u_(calx::parameter(descriptor, c, "half_u")),
        half_v_(calx::parameter(descriptor, c, "half_v")),
        divisions_(static_cast<uint32_t>(calx::parameter(descriptor, c, "divisions"))) {
    for (int k = 0; k < 3; ++k) point_[k] = c.value[k];
    const double length = std::sqrt(c.value[3] * c.value[3] + c.value[4] * c.value[4] + c.value[5] * c.value[5]);
    if (!(length > 0)) throw calx::ConfigError("normal: [0, 0, 0] has no direction; give a vector such as [0, 0, 1]");
    double n[3];
    for (int k = 0; k < 3; ++k) n[k] = c.value[3 + k] / length;
    const int along = std::fabs(n[0]) < 0.9 ? 0 : 1;
    for (int k = 0; k < 3; ++k) u_[k] = (k == along ? 1 : 0) - n[along] * n[k];
    const double u = std::sqrt(u_[0] * u_[0] + u_[1] * u_[1] + u_[2] * u_[2]);
    for (int k = 0; k < 3; ++k) u_[k] /= u;
    for (int k = 0; k < 3; ++k) v_[k] = n[(k + 1) % 3] * u_[(k + 2) % 3] - n[(k + 2) % 3] * u_[(k + 1) % 3];
  }

  calx_status send(const calx_shape_sink* sink) const override {
    const uint32_t n = divisions_;
    calx::shape::Triangles all;
    double x[3];
    for (uint32_t j = 0; j <= n; ++j)
      for (uint32_t i = 0; i <= n; ++i) {
        for (int k = 0; k < 3; ++k)
          x[k] = point_[k] + half_u_ * (2.0 * i / n - 1) * u_[k] + half_v_ * (2.0 * j / n - 1) * v_[k];
        all.corner(x[0], x[1], x[2]);
      }
    for (uint32_t j = 0; j < n; ++j)
      for (uint32_t i = 0; i < n; ++i) {
        const uint32_t a = j * (n + 1) + i;
        all.quad(a, a + 1, a + n + 2, a + n + 1);
      }
    return all.send(sink);
  }

 private:
  double point_[3], u_[3], v_[3], half_u_, half_v_;
  uint32_t divisions_;
};

const calx_descriptor Plane::descriptor =
    calx::shape::descriptor("calx.plane", "Plane", "1.0.0", "Calx", "Apache-2.0", "A flat rectangular wall.", fields);

}  // namespace

CALX_PLUGIN(Plane)
