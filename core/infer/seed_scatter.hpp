// seed_scatter.hpp: how runs that differ in their seed alone scatter: per block a white part and one common mode.
// A raw sample covariance would be useless: a few runs against hundreds of numbers.
#pragma once
#include <vector>

#include "infer/observables.hpp"

namespace calx::infer {

/// Per block, in declared measurement sd. A block of one number has only the white part.
struct SeedScatter {
  std::vector<double> white, common;

  Matrix covariance(const Observables& observables) const;  // of one run, in squared units of the observables
};

/// groups: runs of one set of parameters each, one column per run, rows as the observables. Moments of the residuals
/// about the mean of each group. Fails with Fault::settings where no group has two runs.
SeedScatter estimate_scatter(const Observables& observables, const std::vector<Matrix>& groups);

}  // namespace calx::infer
