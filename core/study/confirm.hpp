// confirm.hpp: what the linear model says, held against real runs: parameters and strengths fitted by runs, then old
// and extended case with new seeds against the data held out. Private to study/.
#pragma once
#include <vector>

#include "infer/diagnosis.hpp"
#include "study/diagnose.hpp"

namespace calx {

/// A model with nothing but numbers: nuisance parameters, standardised, and strengths of effects of the linear model.
struct RealModel {
  infer::Vector u;
  std::vector<std::size_t> effects;
  std::vector<infer::Vector> amplitudes;
};

struct RealFit {
  RealModel model;
  std::vector<double> sd;      // of each strength, along its direction
  infer::Vector figures = {};  // mean of the runs there
  infer::Matrix freedom = {};  // what the data leave open of parameters and strengths: covariance of figures, root
};

/// Gauss-Newton steps from `start` towards the fitted campaign, every step by the mean of runs with the same seeds and
/// with secants corrected by what the runs gave (Broyden 1965); the best place of all is kept. Steps end where a
/// parameter would leave its range. Throws what StudySimulator::run_settings throws for the start.
RealFit fit_by_runs(const StudyDiagnosis& d, StudySimulator& simulator, const RealModel& start, int rounds, int seeds);

/// The fit test asked what the runs at the place of a fit, so many seeds of them, leave of both campaigns. Formulas of
/// the effects are held to be right within their tolerance.
infer::FitCheck check_runs(const StudyDiagnosis& d, const RealFit& fit, std::size_t seeds);

/// Log score of the held-out data, but for a constant, given means of so many runs.
double held_out_score(const StudyDiagnosis& d, const infer::Vector& figures, std::size_t seeds);

/// Means of runs of both models with new seeds, scored on the held-out campaign.
Confirmation confirm_by_runs(const StudyDiagnosis& d, StudySimulator& simulator, const RealModel& old,
                             const RealModel& extended, std::size_t seeds);

}  // namespace calx
