// heavy_tails.hpp: measurement noise as plants have it, for simulated data sets.
#pragma once
#include <cmath>

#include "base/random.hpp"
#include "infer/observables.hpp"

namespace calx::infer {

/// Relative uncertainty of the noise sd of a block in simulated data.
constexpr double noise_sd_error = 0.2;

/// t with 5 degrees of freedom, scaled to variance one.
inline double heavy_tailed(Random& random) {
  const double z = random.normal(), n = random.normal();
  const double chi = n * n - 2 * std::log((1 - random.uniform()) * (1 - random.uniform()));
  return z / std::sqrt(chi / 5) / std::sqrt(5.0 / 3);
}

/// Scales the noise of each block by a random factor around one.
inline void misstate_blocks(Random& random, const Observables& observables, Eigen::Ref<Vector> noise) {
  for (std::size_t b = 0; b < observables.blocks.size(); ++b)
    noise.segment(observables.first(b), observables.size(b)) *= std::exp(noise_sd_error * random.normal());
}

}  // namespace calx::infer
