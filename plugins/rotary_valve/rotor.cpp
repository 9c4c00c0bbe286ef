// rotor.cpp: the cross-section of the rotor drawn once round and stretched along its axis.
#include <cmath>

#include "rotary_valve.hpp"

namespace {

const double pi = 3.14159265358979324;
// Facets of hub and vane tips: at most 3 degrees, so a hub of 10 mm is off by 0.0034 mm.
const double facet = pi / 60;

// Presets: one consistent set of dimensions; each is an assumption, since the publication gives none.
const calx_field fields[] = {
    {"position_x", "m", "middle of the rotor, x (assumption)", -1e6, 1e6, 0.0577, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the rotor, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the rotor, z (assumption)", -1e6, 1e6, 0.535, CALX_VEC(1), 0},
    {"pockets", "1", "number of pockets and of vanes", 2, 100, 6, CALX_FIELD_INTEGER, 0},
    {"outer_radius", "m", "radius of the vane tips (assumption)", 1e-9, 1e6, 0.025, 0, 0},
    {"hub_radius", "m", "radius of the hub (assumption)", 1e-9, 1e6, 0.010, 0, 0},
    {"length", "m", "length along y (assumption)", 1e-9, 1e6, 0.040, 0, 0},
    {"vane_thickness", "m", "thickness of the parallel-sided vanes (assumption)", 1e-9, 1e6, 0.002, 0, 0},
    {"angle", "rad", "turn about +y at rest; 0 has a pocket centred on top (assumption)", -7, 7, 0, 0, 0},
    {"eccentricity", "m", "distance of the body's centre from position, about which its motion turns", 0, 1e3, 0, 0, 0},
    {"eccentricity_angle", "rad", "direction of that at rest, from the top towards +x", -7, 7, 0, 0, 0},
    {"blocked_pocket", "1", "number of a pocket with caked powder at its root; 0 is on top at angle 0", 0, 99, 0,
     CALX_FIELD_INTEGER, 0},
    {"blocked_share", "1", "share of the ring between hub and tips that is filled there", 0, 0.99, 0, 0, 0}};

/// Points of an arc about the origin between two points of it, the first left out, angles from the top towards +x.
void arc(std::vector<double>& x_z, double radius, double from, double to) {
  const int n = static_cast<int>(std::ceil((to - from) / facet - 1e-9));
  for (int k = 1; k <= n; ++k) {
    const double a = from + (to - from) * k / n;
    x_z.push_back(radius * std::sin(a));
    x_z.push_back(radius * std::cos(a));
  }
}

}  // namespace

Rotor::Rotor(const calx_host*, const calx_config& c) {
  const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
  calx::shape::read_vector(descriptor, c, "position", position_);
  pockets_ = static_cast<int>(get("pockets"));
  radius_ = get("outer_radius");
  hub_ = get("hub_radius");
  length_ = get("length");
  half_vane_ = get("vane_thickness") / 2;
  angle_ = get("angle");
  blocked_ = static_cast<int>(get("blocked_pocket"));
  const double share = get("blocked_share"), aside = get("eccentricity"), towards = get("eccentricity_angle");
  if (share > 0 && blocked_ >= pockets_)
    throw calx::ConfigError("blocked_pocket: " + std::to_string(blocked_) + " of a rotor of " +
                            std::to_string(pockets_) + " pockets, which count from 0");
  blocked_hub_ = share > 0 ? std::sqrt(hub_ * hub_ + share * (radius_ * radius_ - hub_ * hub_)) : hub_;
  position_[0] += aside * std::sin(towards);
  position_[2] += aside * std::cos(towards);
  if (hub_ >= radius_)
    throw calx::ConfigError("hub_radius: " + std::to_string(hub_) +
                            " m is not below outer_radius = " + std::to_string(radius_) + " m");
  if (half_vane_ >= hub_ * std::sin(pi / pockets_))
    throw calx::ConfigError("vane_thickness: " + std::to_string(pockets_) + " vanes of " +
                            std::to_string(2 * half_vane_) + " m leave no pocket at the hub; give less than " +
                            std::to_string(2 * hub_ * std::sin(pi / pockets_)) + " m");
}

calx_status Rotor::send(const calx_shape_sink* sink) const {
  const double pitch = 2 * pi / pockets_;
  const double at_tip = std::asin(half_vane_ / radius_);
  // Vane k stands before pocket k + 1.
  const auto root = [&](int pocket) { return pocket % pockets_ == blocked_ ? blocked_hub_ : hub_; };
  std::vector<double> x_z;
  const auto add = [&](double radius, double a) {
    x_z.push_back(radius * std::sin(a));
    x_z.push_back(radius * std::cos(a));
  };
  // A vane stands half a pitch beside the pocket on top.
  const double first = angle_ + 0.5 * pitch;
  add(root(0), first - std::asin(half_vane_ / root(0)));
  for (int k = 0; k < pockets_; ++k) {
    const double vane = first + k * pitch, hub = root(k + 1), at_hub = std::asin(half_vane_ / hub);
    add(radius_, vane - at_tip);
    arc(x_z, radius_, vane - at_tip, vane + at_tip);
    add(hub, vane + at_hub);
    arc(x_z, hub, vane + at_hub, vane + pitch - at_hub);
  }
  Prism prism(position_);
  prism.add(x_z, {-length_ / 2, length_ / 2});
  return prism.send(sink);
}

const calx_descriptor Rotor::descriptor =
    calx::shape::descriptor("calx.rotary-valve", "Rotary valve rotor", "1.0.0", "Calx", "Apache-2.0",
                            "The rotor of a rotary valve: hub and parallel-sided vanes.", fields);
