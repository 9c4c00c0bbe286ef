// seed_scatter.hpp: how runs that differ in their seed alone scatter: per block one common mode and a rest that may be
// correlated along the index and larger in one place than in another.
// A raw sample covariance would be useless: a few runs against hundreds of numbers.
#pragma once
#include <vector>

#include "infer/observables.hpp"

namespace calx::infer {

/// Per block, in declared measurement sd. A block of one number has only the white part.
struct SeedScatter {
  std::vector<double> white, common;
  std::vector<double> correlation;  // lag-one, of the white part along the index
  std::vector<Vector> profile;      // sd of each number over the declared one, mean square one

  Matrix block(const Block& block, std::size_t number) const;  // of one run, in squared declared sd
  Matrix covariance(const Observables& observables) const;     // of one run, in squared units of the observables
};

/// groups: runs of one set of parameters each, one column per run, rows as the observables. Moments of the residuals
/// about the mean of each group. Fails with Fault::settings where no group has two runs. Correlation along the index is
/// taken where it is more probable by far than none: a mass that grows scatters as a sum does, and what is held to be
/// white there makes right models look wrong.
SeedScatter estimate_scatter(const Observables& observables, const std::vector<Matrix>& groups);

/// Variances of numbers that are held to be alike, each estimated with so many degrees of freedom, over their mean:
/// drawn to one by as much as chance alone would spread them (empirical Bayes).
Vector shrunk_variances(const Vector& variances, double freedom);

}  // namespace calx::infer
