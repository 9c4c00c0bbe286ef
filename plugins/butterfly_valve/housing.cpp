// housing.cpp: the bore of a butterfly valve (smooth), and below it a loft from the round bore to a rectangle and a
// rectangular throat (triangles) that ends on the bore of a rotary valve, so that no gap and no ledge remains there.
#include <algorithm>
#include <cmath>

#include "butterfly_valve.hpp"

namespace {

const double turn = 6.28318530717958648;

const calx_field fields[] = {
    {"position_x", "m", "middle of the lower end of the bore, x (assumption)", -1e6, 1e6, 0.0577, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the lower end of the bore, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the lower end of the bore, z (assumption)", -1e6, 1e6, 0.605, CALX_VEC(1), 0},
    {"bore_radius", "m", "radius of the bore (assumption: DN50)", 1e-9, 1e6, 0.025, 0, 0},
    {"bore_height", "m", "height of the bore (assumption)", 1e-9, 1e6, 0.065, 0, 0},
    {"throat", "no|yes", "yes adds loft and throat below the bore", 0, 1, 1, CALX_FIELD_CHOICE, 0},
    {"loft_height", "m", "height over which the bore becomes a rectangle (assumption)", 1e-9, 1e6, 0.030, 0, 0},
    {"throat_width", "m", "width of the throat along x (assumption: the rotary valve's port)", 1e-9, 1e6, 0.0442, 0, 0},
    {"throat_depth", "m", "depth of the throat along y (assumption: the rotor's length)", 1e-9, 1e6, 0.040, 0, 0},
    {"rotor_z", "m", "height of the rotor axis below the throat (assumption)", -1e6, 1e6, 0.535, 0, 0},
    {"rotor_bore", "m", "radius of the rotor housing on which the throat ends (assumption)", 1e-9, 1e6, 0.0255, 0, 0},
    {"edge_setback", "m", "height of the rounded or bevelled port edges, made by the rotor housing", 0, 1, 0.0008, 0,
     0},
    {"facets", "1", "facets round the loft's upper end", 8, 1000, 72, CALX_FIELD_INTEGER, 0}};

}  // namespace

Housing::Housing(const calx_host*, const calx_config& c) {
  const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
  calx::shape::read_vector(descriptor, c, "position", position_);
  bore_radius_ = get("bore_radius");
  bore_height_ = get("bore_height");
  has_throat_ = get("throat") > 0.5;
  loft_height_ = get("loft_height");
  half_width_ = get("throat_width") / 2;
  half_depth_ = get("throat_depth") / 2;
  rotor_z_ = get("rotor_z");
  rotor_bore_ = get("rotor_bore");
  edge_setback_ = get("edge_setback");
  facets_ = static_cast<int>(get("facets"));
  if (!has_throat_) return;
  if (half_width_ >= rotor_bore_)
    throw calx::ConfigError("throat_width: " + std::to_string(2 * half_width_) + " m does not fit on rotor_bore = " +
                            std::to_string(rotor_bore_) + " m; it must be below twice that radius");
  if (position_[2] - loft_height_ <= rotor_z_ + rotor_bore_)
    throw calx::ConfigError(
        "loft_height: the loft ends at z = " + std::to_string(position_[2] - loft_height_) +
        " m, within the rotor housing, whose top is at z = " + std::to_string(rotor_z_ + rotor_bore_) + " m");
}

/// Height of the throat's lower end at x from the axis: on the rotor bore; beside it above the port's edge.
double Housing::throat_end(double x, bool beside) const {
  return rotor_z_ + std::sqrt(rotor_bore_ * rotor_bore_ - x * x) + (beside ? edge_setback_ : 0);
}

calx_status Housing::send(const calx_shape_sink* sink) const {
  const double up[3] = {0, 0, 1};
  const double r_z[] = {bore_radius_, 0, bore_radius_, bore_height_};
  const calx_status status = sink->revolution(sink, position_, up, 2, r_z, 0);
  if (status < 0 || !has_throat_) return status;

  // Rulings at equal angles, through the rectangle's corners, and close to them on the side walls, whose lower rim
  // steps up from the port's corner there.
  std::vector<double> angles, own;
  const double corner = std::atan2(half_depth_, half_width_), close = 0.01;
  for (const double a : {corner, turn / 2 - corner, turn / 2 + corner, turn - corner}) own.push_back(a);
  for (const double a : {corner - close, turn / 2 - corner + close, turn / 2 + corner - close, turn - corner + close})
    own.push_back(a);
  for (int k = 0; k < facets_; ++k) {
    const double a = turn * k / facets_;
    if (std::none_of(own.begin(), own.end(), [&](double b) { return std::fabs(a - b) < close; })) angles.push_back(a);
  }
  angles.insert(angles.end(), own.begin(), own.end());
  std::sort(angles.begin(), angles.end());

  calx::shape::Triangles all;  // three rings: round end, rectangle, lower end
  const uint32_t n = static_cast<uint32_t>(angles.size());
  const auto add = [&](double x, double y, double z) { all.corner(position_[0] + x, position_[1] + y, z); };
  for (const double a : angles) add(bore_radius_ * std::cos(a), bore_radius_ * std::sin(a), position_[2]);
  for (int ring = 0; ring < 2; ++ring)
    for (const double a : angles) {
      const double cx = std::cos(a), cy = std::sin(a);
      const double to_side = half_width_ / std::max(std::fabs(cx), 1e-12);
      const double to_end = half_depth_ / std::max(std::fabs(cy), 1e-12);
      const double s = std::min(to_side, to_end);
      const bool beside = to_side < to_end * (1 - 1e-9);
      const double x = s * cx, y = s * cy;
      add(x, y, ring == 0 ? position_[2] - loft_height_ : throat_end(x, beside));
    }
  for (uint32_t ring = 0; ring < 2; ++ring)
    for (uint32_t k = 0; k < n; ++k) {
      // Counter-clockwise from outside; ring 0 is above ring 1.
      const uint32_t a = ring * n + k, b = ring * n + (k + 1) % n;
      all.quad(a, a + n, b + n, b);
    }
  return all.send(sink);
}

const calx_descriptor Housing::descriptor =
    calx::shape::descriptor("calx.butterfly-housing", "Butterfly housing", "1.0.0", "Calx", "Apache-2.0",
                            "The bore of a butterfly valve, with the loft and throat below it as an option.", fields);
