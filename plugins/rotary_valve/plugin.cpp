#include "rotary_valve.hpp"

void Prism::add(const std::vector<double>& x_z, const std::vector<double>& levels) {
  const uint32_t base = static_cast<uint32_t>(xyz_.size() / 3), points = static_cast<uint32_t>(x_z.size() / 2);
  for (const double y : levels)
    for (uint32_t k = 0; k < points; ++k) {
      xyz_.push_back(origin_[0] + x_z[2 * k]);
      xyz_.push_back(origin_[1] + y);
      xyz_.push_back(origin_[2] + x_z[2 * k + 1]);
    }
  for (uint32_t level = 0; level + 1 < levels.size(); ++level)
    for (uint32_t k = 0; k + 1 < points; ++k) {
      const uint32_t a = base + level * points + k, b = a + 1, c = b + points, d = a + points;
      const uint32_t two[] = {a, b, c, a, c, d};
      index_.insert(index_.end(), two, two + 6);
    }
}

calx_status Prism::send(const calx_shape_sink* sink) const {
  return sink->triangles(sink, xyz_.size() / 3, xyz_.data(), index_.size() / 3, index_.data());
}

CALX_PLUGIN(Rotor, RotorHousing)
