// sampler.hpp: draws from a density known up to a factor. 1 to 10 dimensions, some 1e5 evaluations.
#pragma once
#include <Eigen/Dense>
#include <cstdint>
#include <functional>

namespace calx {

struct SamplerSettings {
  std::size_t steps = 1500;    // moves of every walker, those before "first" included
  std::size_t first = 500;     // moves that are thrown away
  std::size_t keep_every = 5;  // of the rest
  std::uint64_t seed = 1;
};

struct Samples {
  Eigen::MatrixXd x;            // one draw a row
  Eigen::VectorXd log_density;  // of each draw
  double acceptance = 0;        // share of moves taken
  double effective = 0;         // independent draws they are worth, of the worst dimension
};

/// The affine-invariant ensemble of Goodman and Weare (2010), Comm. App. Math. Comp. Sci. 5, 65: stretch moves with
/// a = 2, walkers in two halves that move in turn. Blind to scales and correlations. start: one walker a row, an even
/// number, at least 2 dimensions + 2 of them, where the density is above 0. log_density: natural logarithm, -infinity
/// where the density is 0. The same seed gives the same draws. Throws std::invalid_argument for too few walkers.
Samples draw(const std::function<double(const Eigen::VectorXd&)>& log_density, const Eigen::MatrixXd& start,
             const SamplerSettings& settings);

}  // namespace calx
