// self_test.hpp: the same analysis on synthetic data drawn from the fitted model, without a run of the simulator: what
// these data can show, and how often stated probabilities are true.
#pragma once
#include <vector>

#include "infer/diagnosis.hpp"

namespace calx::infer {

struct SelfTest {
  struct Power {
    std::size_t effect = 0;
    double amplitude = 0;  // in scales of the effect
    int studies = 0, right = 0, wrong = 0;
  };
  std::vector<Power> powers;
  int controls = 0, controls_named = 0;
  IsotonicMap calibration;  // of the inclusion probabilities
};

/// Draws `studies` data sets per effect and amplitude, and as many controls: nuisances from their prior, systematic
/// errors and shape of the signature from the error budget, noise with tails of t with 5 degrees of freedom, sd of each
/// block uncertain by 20 %. amplitudes: in scales of the effect. Deterministic from the seed of the options,
/// on all cores. Throws what diagnose throws.
SelfTest self_test(const LinearModel& model, const Bank& bank, const std::vector<std::size_t>& effects,
                   const std::vector<double>& amplitudes, int studies, const Options& options);

}  // namespace calx::infer
