// butterfly_valve.hpp: the two parts of a butterfly valve. x to the right, y along the shaft, z up, m.
#ifndef BUTTERFLY_VALVE_HPP
#define BUTTERFLY_VALVE_HPP
#include <calx/shape.hpp>
#include <vector>

/// calx.butterfly-valve: the disc, a thick round plate about its own axis.
class Disc : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  Disc(const calx_host* host, const calx_config& config);
  calx_status send(const calx_shape_sink* sink) const override;

 private:
  double position_[3], normal_[3], radius_, half_;
};

/// calx.butterfly-housing: the bore, and below it the loft and throat that lead to a rotary valve.
class Housing : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;
  Housing(const calx_host* host, const calx_config& config);
  calx_status send(const calx_shape_sink* sink) const override;

 private:
  double throat_end(double x, bool beside) const;

  double position_[3], bore_radius_, bore_height_;
  bool has_throat_;
  double loft_height_, half_width_, half_depth_, rotor_z_, rotor_bore_, edge_setback_;
  int facets_;
};

#endif
