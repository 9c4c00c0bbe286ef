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

/// An effect that is part of an explanation, with what the fit says of it.
struct Part {
  std::size_t effect = 0;
  Vector amplitude;
  double shape_factor = 1;
};

/// Only parameters carry over from the fitted campaign: nuisances, and amplitudes of the effects named. What the error
/// budget tolerates is drawn anew, as at new conditions; otherwise the old model would "predict" a repetition by heart.
/// Under the old model the ratio is an e-value: P(log_score >= 3) <= exp(-3) (Wasserman, Ramdas and Balakrishnan 2020).
Gain held_out_gain(const LinearModel& model, const Budget& budget, const std::vector<Part>& parts,
                   const Options& options);

/// The same for a term of the bank with a free strength.
Gain held_out_gain(const LinearModel& model, const Budget& budget, const Term& term, double strength);

/// What parts of an explanation add: columns of free amplitudes, standardised, and covariance of uncertain shapes.
struct Freedom {
  Matrix columns, own;
};
Freedom freedom_of(const LinearModel& model, const std::vector<Part>& parts, const Options& options);

}  // namespace calx::infer
