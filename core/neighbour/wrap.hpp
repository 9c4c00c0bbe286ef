// wrap.hpp: periodic directions of the domain.
#pragma once
#include <array>

#include "base/vec3.hpp"

namespace calx {

/// Periodic box; only directions marked periodic wrap.
struct Wrap {
  Vec3 lo, length;  // m
  std::array<bool, 3> periodic{false, false, false};
  bool any() const { return periodic[0] || periodic[1] || periodic[2]; }
  /// Shortest image of a difference of positions.
  Vec3 nearest(Vec3 d) const {
    for (int k = 0; k < 3; ++k)
      if (periodic[static_cast<std::size_t>(k)]) {
        if (d[k] > 0.5 * length[k]) d[k] -= length[k];
        if (d[k] < -0.5 * length[k]) d[k] += length[k];
      }
    return d;
  }
  /// A coordinate along direction k moved into the box.
  double inside(double x, int k) const {
    if (x >= lo[k] && x < lo[k] + length[k]) return x;
    return x - length[k] * std::floor((x - lo[k]) / length[k]);
  }
};

}  // namespace calx
