// cylinder.cpp: a round tube between two points, calx.cylinder: exact as a surface of revolution, or faceted.
#include <calx/shape.hpp>
#include <cmath>
#include <vector>

namespace {

const calx_field fields[] = {
    {"from_x", "m", "middle of the bottom end, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"from_y", "m", "middle of the bottom end, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"from_z", "m", "middle of the bottom end, z", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"to_x", "m", "middle of the top end, x", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"to_y", "m", "middle of the top end, y", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"to_z", "m", "middle of the top end, z", -1e6, 1e6, 1, CALX_VEC(2), 0},
    {"radius", "m", "radius of the tube", 1e-9, 1e6, 0.5, 0, 0},
    {"caps", "none|bottom|top|both", "ends that are closed by a disc; bottom is at `from`", 0, 3, 0, CALX_FIELD_CHOICE,
     0},
    {"facets", "1", "flat facets round the tube, their edges on the circle; 0 is smooth and exact", 0, 10000, 0,
     CALX_FIELD_INTEGER, 0}};

class Cylinder : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  Cylinder(const calx_host*, const calx_config& c)
      : radius_(calx::parameter(descriptor, c, "radius")),
        facets_(static_cast<uint32_t>(calx::parameter(descriptor, c, "facets"))) {
    const int caps = static_cast<int>(calx::parameter(descriptor, c, "caps"));
    bottom_ = caps == 1 || caps == 3;
    top_ = caps == 2 || caps == 3;
    length_ = 0;
    for (int k = 0; k < 3; ++k) {
      from_[k] = c.value[k];
      axis_[k] = c.value[3 + k] - c.value[k];
      length_ += axis_[k] * axis_[k];
    }
    length_ = std::sqrt(length_);
    if (!(length_ > 0))
      throw calx::ConfigError("from and to: both ends are the same point; give a cylinder some length");
    for (int k = 0; k < 3; ++k) axis_[k] /= length_;
    if (facets_ == 1 || facets_ == 2)
      throw calx::ConfigError("facets: " + std::to_string(facets_) + " is too few; give 0 (smooth) or 3 and more");
  }

  calx_status send(const calx_shape_sink* sink) const override { return facets_ ? faceted(sink) : smooth(sink); }

 private:
  calx_status smooth(const calx_shape_sink* sink) const {
    std::vector<double> r_z;
    const auto add = [&](double r, double z) { r_z.push_back(r), r_z.push_back(z); };
    if (bottom_) add(0, 0);
    add(radius_, 0);
    add(radius_, length_);
    if (top_) add(0, length_);
    return sink->revolution(sink, from_, axis_, r_z.size() / 2, r_z.data(), 0);
  }

  calx_status faceted(const calx_shape_sink* sink) const {
    const uint32_t n = facets_;
    const int along = std::fabs(axis_[0]) < 0.9 ? 0 : 1;
    double e1[3], e2[3];
    for (int k = 0; k < 3; ++k) e1[k] = (k == along ? 1 : 0) - axis_[along] * axis_[k];
    const double e = std::sqrt(e1[0] * e1[0] + e1[1] * e1[1] + e1[2] * e1[2]);
    for (int k = 0; k < 3; ++k) e1[k] /= e;
    for (int k = 0; k < 3; ++k) e2[k] = axis_[(k + 1) % 3] * e1[(k + 2) % 3] - axis_[(k + 2) % 3] * e1[(k + 1) % 3];
    calx::shape::Triangles all;
    const auto corner = [&](double z, double r, double angle) {
      double x[3];
      for (int k = 0; k < 3; ++k)
        x[k] = from_[k] + z * axis_[k] + r * (std::cos(angle) * e1[k] + std::sin(angle) * e2[k]);
      return all.corner(x[0], x[1], x[2]);
    };
    for (const double z : {0.0, length_})
      for (uint32_t f = 0; f < n; ++f) corner(z, radius_, 6.28318530717958648 * f / n);
    const uint32_t bottom = corner(0, 0, 0), top = corner(length_, 0, 0);
    for (uint32_t f = 0; f < n; ++f) {
      const uint32_t a = f, b = (f + 1) % n, c = n + b, d = n + f;
      all.quad(a, b, c, d);
      if (bottom_) all.triangle(bottom, b, a);
      if (top_) all.triangle(top, d, c);
    }
    return all.send(sink);
  }

  double from_[3], axis_[3], length_, radius_;
  uint32_t facets_;
  bool bottom_, top_;
};

const calx_descriptor Cylinder::descriptor =
    calx::shape::descriptor("calx.cylinder", "Cylinder", "1.0.0", "Calx", "Apache-2.0",
                            "A round tube or drum between two points, smooth or faceted.", fields);

}  // namespace

CALX_PLUGIN(Cylinder)
