// confusability.hpp: which causes leave the same traces, so that no analysis of these data can tell them apart.
#pragma once
#include <vector>

#include "infer/causes.hpp"

namespace calx::infer {

constexpr double least_apart = 3;  // sd; causes nearer than this cannot be told apart

struct Confusability {
  std::vector<double> detectability;  // delta: amplitude over its noise after recalibration, at the fitted amplitude
  Matrix cosine;                      // between signatures in the metric of the residuals, -1..1
  Matrix distance;                    // (k, l): delta_k of the best imitation of k by l; expected ln odds d^2 / 2
  std::vector<std::vector<std::size_t>> groups;  // effects closer than `apart`, transitively; singletons left out
};

/// amplitudes: per effect, at which they are compared; an effect of two components counts along its amplitude. A
/// one-sided effect cannot imitate the opposite sign. apart: distance below which two causes are one group.
Confusability compare_causes(const LinearModel& model, const Metric& metric, const std::vector<Vector>& amplitudes,
                             double apart = least_apart);

}  // namespace calx::infer
