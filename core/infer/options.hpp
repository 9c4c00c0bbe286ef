// options.hpp: settings of a diagnosis with their presets.
#pragma once
#include <cstdint>
#include <vector>

#include "infer/isotonic.hpp"

namespace calx::infer {

struct Options {
  std::uint64_t seed = 1;

  // Plan of runs.
  std::vector<int> base_runs = {3, 3, 9};  // with independent seeds, before each of the re-based fits
  double reach = 1e9;                      // prior sd beyond which no base run is made
  int slope_runs = 1;                      // pairs of runs behind each sensitivity
  double step_scales = 2;                  // amplitude of an effect's run, in its scales
  int effect_runs = 1;                     // seeds behind each signature
  int refined = 3;                         // effects run again at their fitted amplitudes
  int refined_runs = 1;                    // seeds of each of these
  double common_numbers = -1;              // correlation of runs of one seed, 0..1; -1: estimate it

  // Error budget, in declared measurement sd.
  double tolerance = 0.35;       // of the model, half white and half smooth
  double numerical = 0.3;        // time step, scale, domain: constant or smooth per block
  double declared_error = 0.2;   // relative uncertainty of each declared sd
  double shape = 0.3;            // relative uncertainty of a signature's shape
  double shape_length = 0.35;    // of the index
  bool signature_noise = false;  // what is left of the scatter of the runs behind a signature

  // Prior shares: nothing, one effect, two effects, something outside the library.
  double prior_none = 0.30, prior_single = 0.40, prior_pair = 0.10, prior_unknown = 0.20;

  // Decision.
  double name_above = 0.9;
  double unknown_above = 0.75;  // below, "not in the library" is one of several explanations
  double fitted_above = 0.1;    // probability that the fitted campaign alone must give a named effect
  double screen_above = 4.5;    // sd; leave-one-out residuals beyond it are events
  double gain_above = 3;        // nats of held-out log score
  double partner_above = 1;     // nats that a second named effect must add
  double fit_above = 0.01;      // p of the fit test
  double global_above = 0.05;   // p below which "no discrepancy shown" is not said
  int nulls = 400;              // simulated data sets behind every p
  IsotonicMap calibration;      // of stated probabilities; empty: none

  // Parts of the method that tests switch off to see the result get worse.
  bool recalibrate = true, seed_scatter = true, unknown_rival = true, pairs = true, stacking = true;
};

}  // namespace calx::infer
