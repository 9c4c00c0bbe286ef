// SPDX-License-Identifier: MIT
// calx/shape.hpp: optional C++11 helper for wall shapes; header only. The table of calx.geometry/1 in C++, a descriptor
// in one call, surfaces of revolution and triangles.
//
//   class Funnel : public calx::shape::Shape {
//    public:
//     static const calx_descriptor descriptor;
//     Funnel(const calx_host* host, const calx_config& config);               // may throw calx::ConfigError("why")
//     calx_status send(const calx_shape_sink* sink) const override;           // calls sink->triangles,
//     sink->revolution
//   };
//   const calx_descriptor Funnel::descriptor = calx::shape::descriptor("org.example.funnel", "Funnel", ..., fields);
//   CALX_PLUGIN(Funnel)
#ifndef CALX_SHAPE_HPP
#define CALX_SHAPE_HPP
#include <calx/plugin.hpp>
#include <vector>

namespace calx {
namespace shape {

/// Base of a wall shape: implements the C table. send may throw and returns CALX_OK or what a call of the sink
/// returned.
class Shape : public Instance {
 public:
  virtual calx_status send(const calx_shape_sink* sink) const = 0;

  const void* get_interface(const char* id) const override {
    static const calx_geometry table = {sizeof(calx_geometry), CALX_ABI_DRAFT, &build};
    return std::strcmp(id, CALX_GEOMETRY) == 0 ? &table : 0;
  }

 private:
  static calx_status CALX_CALL build(const calx_instance* self, const calx_host* host,
                                     const calx_shape_sink* sink) noexcept {
    calx_status status = CALX_OK;
    const calx_status mine = guard(host, [&] { status = static_cast<const Shape*>(self)->send(sink); });
    return mine < 0 ? mine : status;
  }
};

/// Descriptor of a shape whose parameters stand in a static array of fields.
template <uint32_t N>
constexpr calx_descriptor descriptor(const char* id, const char* name, const char* version, const char* vendor,
                                     const char* license, const char* summary, const calx_field (&fields)[N],
                                     const char* extra_schema = nullptr) {
  return calx_descriptor{sizeof(calx_descriptor),
                         0,
                         id,
                         CALX_GEOMETRY,
                         name,
                         version,
                         vendor,
                         license,
                         summary,
                         nullptr,
                         fields,
                         N,
                         0,
                         extra_schema};
}

/// The vector group "name" of a parameter table: name_x, name_y, name_z.
inline void read_vector(const calx_descriptor& d, const calx_config& c, const std::string& name, double (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = parameter(d, c, (name + '_' + "xyz"[k]).c_str());
}

/// A smooth surface of revolution about the vertical through the parameter "position": points (r, z) from there, m.
class Revolved : public Shape {
 public:
  Revolved(const calx_descriptor& d, const calx_config& c) { read_vector(d, c, "position", position_); }

  calx_status send(const calx_shape_sink* sink) const override {
    const double up[3] = {0, 0, 1};
    return sink->revolution(sink, position_, up, profile_.size() / 2, profile_.data(), 0);
  }

 protected:
  /// The next point of the profile.
  void add(double r, double z) {
    profile_.push_back(r);
    profile_.push_back(z);
  }

 private:
  double position_[3];
  std::vector<double> profile_;
};

/// Corners, m, and triangles between them, counter-clockwise seen from the side the normal points to.
class Triangles {
 public:
  /// Number of the new corner.
  uint32_t corner(double x, double y, double z) {
    xyz_.push_back(x);
    xyz_.push_back(y);
    xyz_.push_back(z);
    return corners() - 1;
  }
  uint32_t corners() const { return static_cast<uint32_t>(xyz_.size() / 3); }
  double height(uint32_t corner) const { return xyz_[3 * corner + 2]; }

  void triangle(uint32_t a, uint32_t b, uint32_t c) {
    index_.push_back(a);
    index_.push_back(b);
    index_.push_back(c);
  }
  /// Cut from a to c.
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  calx_status send(const calx_shape_sink* sink) const {
    return sink->triangles(sink, corners(), xyz_.data(), index_.size() / 3, index_.data());
  }

 private:
  std::vector<double> xyz_;
  std::vector<uint32_t> index_;
};

}  // namespace shape
}  // namespace calx
#endif
