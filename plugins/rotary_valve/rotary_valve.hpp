// rotary_valve.hpp: the two parts of a rotary valve. The rotor axis is along y; x to the right, z up, m. Angles are
// counted from the top towards +x, which is clockwise seen from -y and a positive turn about +y.
#ifndef ROTARY_VALVE_HPP
#define ROTARY_VALVE_HPP
#include <calx/shape.hpp>
#include <vector>

/// Triangles of walls parallel to y.
struct Prism {
  explicit Prism(const double* origin) : origin_(origin) {}
  /// Strips between neighbouring points (x, z) of a line and neighbouring levels of y; normals to the left of the line
  /// seen from -y. Coordinates from the origin.
  void add(const std::vector<double>& x_z, const std::vector<double>& levels);
  calx_status send(const calx_shape_sink* sink) const { return all_.send(sink); }

 private:
  const double* origin_;
  calx::shape::Triangles all_;
};

/// calx.rotary-valve: hub and parallel-sided vanes; open at both ends, where the housing's end plates stand.
class Rotor : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  Rotor(const calx_host* host, const calx_config& config);
  calx_status send(const calx_shape_sink* sink) const override;

 private:
  double position_[3], radius_, hub_, length_, half_vane_, angle_;
  double blocked_hub_;  // of the blocked pocket
  int pockets_, blocked_;
};

/// calx.rotary-housing: two closed arcs, two ports with their edges, two end plates.
class RotorHousing : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  RotorHousing(const calx_host* host, const calx_config& config);
  calx_status send(const calx_shape_sink* sink) const override;

 private:
  std::vector<double> port_edge() const;
  double position_[3], bore_, length_, port_length_, port_half_angle_, edge_;
  int edge_shape_, facets_;
  bool end_plates_;
};

#endif
