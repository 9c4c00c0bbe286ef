// posterior.hpp: which explanation the data prefer: nothing, one effect, two effects, something outside the library.
#pragma once
#include <vector>

#include "infer/bank.hpp"
#include "infer/causes.hpp"

namespace calx::infer {

struct PairModel {
  std::size_t first, second;
  PairFit fit;
  double probability = 0;
};

struct Posterior {
  double none = 0, unknown = 0;
  std::vector<double> single;     // probability that this effect acts alone
  std::vector<double> inclusion;  // that it acts, alone or in a pair
  std::vector<SingleFit> fits;    // of each effect alone
  std::vector<PairModel> pairs;
  UnknownFit discrepancy;
};

/// Closed-form evidences under one metric. Deterministic.
Posterior weigh(const LinearModel& model, const Bank& bank, const Metric& metric, const Options& options);

/// Explanations whose probabilities, largest first, add up to more than `share`: indices of effects; effect count for
/// "nothing", effect count + 1 for "outside the library".
std::vector<std::size_t> credible_set(const Posterior& posterior, double share);

}  // namespace calx::infer
