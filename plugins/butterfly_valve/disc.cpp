// disc.cpp: the disc of a butterfly valve as a closed surface of revolution about its own axis.
#include <cmath>

#include "butterfly_valve.hpp"

namespace {

// Presets: a DN50 valve, 0.5 mm clearance in its bore (assumptions).
const calx_field fields[] = {
    {"position_x", "m", "middle of the disc, x (assumption)", -1e6, 1e6, 0.0577, CALX_VEC(1), 0},
    {"position_y", "m", "middle of the disc, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"position_z", "m", "middle of the disc, z (assumption)", -1e6, 1e6, 0.640, CALX_VEC(1), 0},
    {"radius", "m", "radius of the disc (assumption: clearance 0.5 mm)", 1e-9, 1e6, 0.0245, 0, 0},
    {"thickness", "m", "thickness of the disc (assumption)", 1e-9, 1e6, 0.004, 0, 0},
    {"angle", "rad", "0: closed, across a vertical bore; positive turns about +y, so pi / 2 is open", -7, 7, 0, 0, 0}};

}  // namespace

Disc::Disc(const calx_host*, const calx_config& c)
    : radius_(calx::parameter(descriptor, c, "radius")), half_(calx::parameter(descriptor, c, "thickness") / 2) {
  calx::shape::read_vector(descriptor, c, "position", position_);
  const double angle = calx::parameter(descriptor, c, "angle");
  normal_[0] = std::sin(angle);
  normal_[1] = 0;
  normal_[2] = std::cos(angle);
}

calx_status Disc::send(const calx_shape_sink* sink) const {
  const double r_z[] = {0, -half_, radius_, -half_, radius_, half_, 0, half_};
  return sink->revolution(sink, position_, normal_, 4, r_z, 0);
}

const calx_descriptor Disc::descriptor = calx::shape::descriptor(
    "calx.butterfly-valve", "Butterfly disc", "1.0.0", "Calx", "Apache-2.0", "The disc of a butterfly valve.", fields);
