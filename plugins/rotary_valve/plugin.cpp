#include "rotary_valve.hpp"

void Prism::add(const std::vector<double>& x_z, const std::vector<double>& levels) {
  const uint32_t base = all_.corners(), points = static_cast<uint32_t>(x_z.size() / 2);
  for (const double y : levels)
    for (uint32_t k = 0; k < points; ++k)
      all_.corner(origin_[0] + x_z[2 * k], origin_[1] + y, origin_[2] + x_z[2 * k + 1]);
  for (uint32_t level = 0; level + 1 < levels.size(); ++level)
    for (uint32_t k = 0; k + 1 < points; ++k) {
      const uint32_t a = base + level * points + k, b = a + 1;
      all_.quad(a, b, b + points, a + points);
    }
}

CALX_PLUGIN(Rotor, RotorHousing)
