// calibrate.hpp: from a study to what its data say of its parameters. Some 20 to 300 runs; the algebra takes seconds.
#pragma once
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "study/executor.hpp"
#include "study/study.hpp"
#include "study/study_run.hpp"

namespace calx {

/// Mean, standard deviation and quantiles of a posterior.
struct Posterior {
  double mean = 0, sd = 0, q05 = 0, q50 = 0, q95 = 0;
  double prior_sd = 0;
  double identifiability = 0;  // sd / prior_sd: near 1 the data say nothing
};

/// Two parameters that the data tell only together.
struct Confounded {
  std::size_t first = 0, second = 0;
  double correlation = 0;
};

/// Prediction of one observable at the posterior beside what was measured; one value per measured place.
struct PredictiveCheck {
  std::vector<double> mean, sd, q05, q95;       // of the mean of the runs, over the posterior, emulator included
  std::vector<double> confirmed, confirmed_sd;  // runs at the posterior mean with new seeds: their mean, its error
  double z = 0;         // distance measured - predicted as a normal deviate; sign of the mean difference for a scalar
  bool agrees = false;  // |z| < 2
};

/// How well an emulator predicts places it has not seen.
struct EmulatorCheck {
  std::vector<double> seen, predicted, sd;  // of the first component, one a place
  double noise_sd = 0;                      // scatter of one run
  std::size_t components = 0;               // emulators of the observable
  double mean_square = 0;                   // of standardised residuals over all components: near 1 when honest
  double share = 0;                         // of the variance on the posterior that is the emulator's own
};

struct Wave {
  std::size_t places = 0, runs = 0;
  bool reduced = false;
  double plausible_share = 0;     // of the ranges, after the wave
  std::vector<double> low, high;  // where plausible values lie, in the parameters' units
};

/// Every run of the study, for the table of runs.
struct RunRow : StudyRun {
  std::size_t wave = 0, place = 0;
};

struct Calibration {
  std::vector<Posterior> parameters;
  Eigen::MatrixXd correlation;
  std::vector<Confounded> confounded;
  std::vector<PredictiveCheck> observables;
  std::vector<EmulatorCheck> emulators;
  std::vector<Wave> waves;
  std::vector<RunRow> runs;
  Eigen::MatrixXd samples;  // one draw a row, in the parameters' units
  Eigen::VectorXd log_density;
  double acceptance = 0, effective = 0;
  std::vector<std::string> notes;
};

/// Waves of runs over a shrinking part of the ranges (history matching), an emulator per figure, and draws from the
/// posterior. The result depends on the study, its seed and the figures of the runs alone, not on jobs or on what was
/// cached. Throws Error(Fault::settings) for a budget too small, Error(Fault::numerics) when too few runs gave figures,
/// and what the executor throws. [main]
Calibration calibrate(const Study& study, Executor& executor, const ProgressSink& sink);

/// calibration.json, cost.json, runs.csv, samples.csv and material.json into the folder. Throws Error(Fault::files).
void write_calibration(const std::string& folder, const Study& study, const Calibration& result);

}  // namespace calx
