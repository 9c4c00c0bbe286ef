// isotonic.hpp: a monotone map from stated to observed probability, learnt by pooling adjacent violators.
#pragma once
#include <utility>
#include <vector>

namespace calx::infer {

struct IsotonicMap {
  std::vector<double> stated, observed;  // both rising; empty: the identity

  /// Linear between the points, constant beyond them.
  double operator()(double probability) const;
};

/// Least-squares monotone fit of outcomes (0 or 1) on stated probabilities, pooled to groups of at least `group`
/// statements (Ayer et al. 1955; Zadrozny and Elkan 2002). Each pool carries one failure more than was seen, so that no
/// map ever promises certainty.
IsotonicMap learn_isotonic(std::vector<std::pair<double, bool>> statements, int group);

}  // namespace calx::infer
