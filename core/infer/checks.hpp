// checks.hpp: does a model fit: tests of residuals against simulated data with heavy tails and uncertain noise.
#pragma once
#include <vector>

#include "infer/bank.hpp"
#include "infer/budget.hpp"

namespace calx::infer {

/// How observable b departs from the model, its residuals recalibrated.
struct BlockCheck {
  double z = 0;               // mean departure in its own sd, positive where the measurement is higher
  double departure = 0;       // mean of measured - simulated, unit of the observable
  double p = 1;               // of the strongest term in this block, all terms of the block looked at
  std::size_t strongest = 0;  // index of that term in the bank
};

struct FitCheck {
  double p = 1;           // global: of the smaller of the two below, doubled
  double total = 1;       // p of the sum of squares
  double structured = 1;  // p of the largest term anywhere
  std::vector<BlockCheck> blocks;
};

/// Null distribution by simulation: Gaussian systematic errors, measurement noise with tails of t with 5 degrees of
/// freedom, sd of each block uncertain by 20 %. A Gaussian null would reject right models (posterior predictive
/// p-values want calibration: Hjort, Dahl and Steinbakk 2006). prior: covariance that the model under test itself adds.
FitCheck check_fit(const LinearModel& model, const Bank& bank, const Matrix& systematic, const Matrix& noise,
                   const Vector& residual, const Options& options, std::uint64_t stream);

}  // namespace calx::infer
