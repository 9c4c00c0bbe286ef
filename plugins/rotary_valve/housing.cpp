// housing.cpp: the bore round the rotor with an inlet port on top and an outlet port below, both over the rotor's
// length.
#include <cmath>

#include "rotary_valve.hpp"

namespace {

const double pi = 3.14159265358979324;
enum EdgeShape { sharp, rounded, bevelled };

// Presets: one consistent set of dimensions; each is an assumption, since the publication gives none.
const calx_field fields[] = {
    {"position_x", "m", "middle of the bore, x (assumption)", -1e6, 1e6, 0.0577, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the bore, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the bore, z (assumption)", -1e6, 1e6, 0.535, CALX_VEC(1), 0},
    {"bore_radius", "m", "radius of the bore (assumption: 0.5 mm over the rotor)", 1e-9, 1e6, 0.0255, 0, 0},
    {"length", "m", "distance between the end plates (assumption)", 1e-9, 1e6, 0.041, 0, 0},
    {"port_length", "m", "length of both ports along y (assumption: that of the rotor)", 1e-9, 1e6, 0.040, 0, 0},
    {"port_half_angle", "rad", "ports reach this far on both sides of top and bottom (assumption: 60 degrees)", 0.05,
     1.52, 1.0471975511965976, 0, 0},
    {"edges", "sharp|round|bevel", "shape of the four port edges parallel to the rotor axis", 0, 2, 1,
     CALX_FIELD_CHOICE, 0},
    {"edge_size", "m", "radius of round edges, leg of bevels (assumption)", 1e-9, 1, 0.003, 0, 0},
    {"end_plates", "no|yes", "yes closes both ends by discs", 0, 1, 1, CALX_FIELD_CHOICE, 0},
    {"facets", "1", "facets for a whole turn of the bore", 36, 10000, 180, CALX_FIELD_INTEGER, 0}};

}  // namespace

RotorHousing::RotorHousing(const calx_host*, const calx_config& c) {
  const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
  calx::shape::read_vector(descriptor, c, "position", position_);
  bore_ = get("bore_radius");
  length_ = get("length");
  port_length_ = get("port_length");
  port_half_angle_ = get("port_half_angle");
  edge_shape_ = static_cast<int>(get("edges"));
  edge_ = get("edge_size");
  end_plates_ = get("end_plates") > 0.5;
  facets_ = static_cast<int>(get("facets"));
  if (port_length_ > length_)
    throw calx::ConfigError("port_length: " + std::to_string(port_length_) +
                            " m is more than length = " + std::to_string(length_) + " m between the end plates");
  const std::vector<double> e = port_edge();
  if (std::atan2(e[e.size() - 2], e[e.size() - 1]) > pi / 2 - 0.01)
    throw calx::ConfigError(
        "edge_size: edges of " + std::to_string(edge_) +
        " m leave no closed arc between the ports; give smaller edges or a smaller port_half_angle");
}

/// The edge on the right of the inlet as points (x, z) from the vertical port wall down to the bore.
std::vector<double> RotorHousing::port_edge() const {
  const double wall = bore_ * std::sin(port_half_angle_), corner = bore_ * std::cos(port_half_angle_);
  std::vector<double> x_z;
  if (edge_shape_ == sharp) return {wall, corner};
  if (edge_shape_ == bevelled) {
    const double a = port_half_angle_ + edge_ / bore_;
    return {wall, corner + edge_, bore_ * std::sin(a), bore_ * std::cos(a)};
  }
  // The rounding's centre lies in the wall: edge_ beside the port wall and edge_ outside the bore.
  const double cx = wall + edge_, cz = std::sqrt((bore_ + edge_) * (bore_ + edge_) - cx * cx);
  // From the side towards -x to the direction of the bore's axis.
  const double from = pi, to = std::atan2(-cz, -cx) + 2 * pi;
  const int n = 6;
  for (int k = 0; k <= n; ++k) {
    const double a = from + (to - from) * k / n;
    x_z.push_back(cx + edge_ * std::cos(a));
    x_z.push_back(cz + edge_ * std::sin(a));
  }
  return x_z;
}

calx_status RotorHousing::send(const calx_shape_sink* sink) const {
  const double half = length_ / 2, port = port_length_ / 2;
  const std::vector<double> edge = port_edge();
  const double begin = std::atan2(edge[edge.size() - 2], edge[edge.size() - 1]);
  const auto arc = [&](double from, double to) {
    std::vector<double> x_z;
    const int n = static_cast<int>(std::ceil((to - from) / (2 * pi) * facets_ - 1e-9));
    for (int k = 0; k <= n; ++k) {
      const double a = from + (to - from) * k / n;
      x_z.push_back(bore_ * std::sin(a));
      x_z.push_back(bore_ * std::cos(a));
    }
    return x_z;
  };
  Prism prism(position_);
  const bool has_strips = half > port;
  const std::vector<double> whole =
      has_strips ? std::vector<double>{-half, -port, port, half} : std::vector<double>{-half, half};
  prism.add(arc(begin, pi - begin), whole);
  prism.add(arc(pi + begin, 2 * pi - begin), whole);
  if (has_strips)
    for (const double middle : {0.0, pi}) {
      prism.add(arc(middle - begin, middle + begin), {-half, -port});
      prism.add(arc(middle - begin, middle + begin), {port, half});
    }
  if (edge.size() > 2)
    for (const double side : {1.0, -1.0})
      for (const double up : {1.0, -1.0}) {
        std::vector<double> x_z;
        const size_t n = edge.size() / 2;
        for (size_t k = 0; k < n; ++k) {
          // A mirrored line is run backwards to keep its normal towards the wall.
          const size_t at = side * up > 0 ? k : n - 1 - k;
          x_z.push_back(side * edge[2 * at]);
          x_z.push_back(up * edge[2 * at + 1]);
        }
        prism.add(x_z, {-port, port});
      }
  const calx_status status = prism.send(sink);
  if (status < 0 || !end_plates_) return status;
  for (const double y : {half, -half}) {
    const double axis[3] = {0, y, 0}, disc[] = {bore_, half, 0, half};
    const calx_status plate = sink->revolution(sink, position_, axis, 2, disc, 0);
    if (plate < 0) return plate;
  }
  return CALX_OK;
}

const calx_descriptor RotorHousing::descriptor =
    calx::shape::descriptor("calx.rotary-housing", "Rotary valve housing", "1.0.0", "Calx", "Apache-2.0",
                            "The housing of a rotary valve: bore with two ports and end plates.", fields);
