// gain.hpp: what an extension of the model is worth on data not used to fit it.
#pragma once
#include <vector>

#include "infer/budget.hpp"
#include "infer/posterior.hpp"

namespace calx::infer {

struct Gain {
  double log_score = 0;  // ln of the held-out likelihood ratio, extended over recalibrated old model
  double sd = 0;         // of log_score, if the extended model is right
  double error_before = 0, error_after = 0;  // root mean square of held-out residuals, in declared sd
};

/// Only parameters carry over from the fitted campaign: nuisances, and amplitudes of the effects named. What the error
/// budget tolerates is drawn anew, as at new conditions; otherwise the old model would "predict" a repetition by heart.
/// Under the old model the ratio is an e-value: P(log_score >= 3) <= exp(-3) (Wasserman, Ramdas and Balakrishnan 2020).
Gain held_out_gain(const LinearModel& model, const Budget& budget, const std::vector<std::size_t>& effects,
                   const std::vector<Vector>& amplitudes, const Options& options);

/// The same for a term of the bank with a free strength.
Gain held_out_gain(const LinearModel& model, const Budget& budget, const Term& term, double strength,
                   const Options& options);

}  // namespace calx::infer
