// diagnosis.hpp: from a linear model and measurements to a verdict with its reasons.
#pragma once
#include <string>
#include <vector>

#include "infer/checks.hpp"
#include "infer/gain.hpp"
#include "infer/posterior.hpp"
#include "infer/screen.hpp"
#include "infer/simulator.hpp"

namespace calx::infer {

enum class Verdict { none, named, ambiguous, unknown };
const char* name(Verdict verdict);

struct Diagnosis {
  Verdict verdict = Verdict::ambiguous;
  std::string reason;
  std::vector<std::size_t> named;    // effects
  std::vector<std::size_t> refused;  // probable, but the fit test refused them
  std::vector<double> probability;   // of each effect, after the calibration map of the options
  Posterior posterior;               // of the campaigns together, or of the fitted one without stacking
  Posterior fitted;                  // of the fitted campaign alone
  FitCheck before, after;            // of the recalibrated model, and with the named effects
  Gain gain;                         // of the named effects, or of the unknown term
  double mixture_score = 0;      // held-out log score of all explanations of the fitted campaign that hold a named one
  Budget budget;                 // screened
  std::vector<Event> events;     // of the fitted campaign
  std::vector<std::size_t> set;  // credible set of 95 %, see credible_set
};

/// Effects as fitted together, where two are given, or alone.
std::vector<Part> parts_of(const Posterior& posterior, const std::vector<std::size_t>& effects);

/// Runs the effects that lead under the model so far at the amplitudes fitted, and corrects their signatures where the
/// response is not proportional to the amplitude: linear model to secant model. Costs options.refined runs at most;
/// instrument effects cost none.
void refine(LinearModel& model, const Bank& bank, Simulator& simulator, const Options& options);

/// Moves the place where the model is linear to u: base runs there with so many new seeds, and a new partner.
/// Signatures and sensitivities stay. For a leading effect whose nuisance parameters lie elsewhere than without it.
void rebase(LinearModel& model, const Vector& u, int seeds, Simulator& simulator, const Options& options);

/// Deterministic from the seed of the options. A cause is named only if its probability is above options.name_above,
/// the fit test does not refuse it, and it predicts the held-out campaign better than the recalibrated old model.
Diagnosis diagnose(const LinearModel& model, const Bank& bank, const Options& options);

/// States the probabilities by options.calibration, as a self-test learnt it after the verdict. A name that is then no
/// longer above options.name_above is withdrawn, and one that the fit test refused no longer stands in `refused`.
void calibrate(Diagnosis& d, const Options& options);

}  // namespace calx::infer
