// experiment.hpp: which further measurement would best tell the remaining explanations apart.
#pragma once
#include <string>
#include <vector>

#include "infer/diagnosis.hpp"

namespace calx::infer {

/// A measurement that could be made: what the model says of it around the place where it is linear.
struct Experiment {
  std::string name;
  double cost = 1;                 // any unit, the same for all
  Vector sd, tolerance;            // of the measurement and of the model, per number
  Vector base;                     // predicted at model.u without effects
  Matrix sensitivities;            // one column per nuisance parameter
  std::vector<Matrix> signatures;  // per effect, a column per component
};

/// An explanation with its prediction of the new numbers given all data so far.
struct Forecast {
  std::vector<std::size_t> effects;  // empty: nothing, unless `outside`
  bool outside = false;
  double probability = 0;
  Vector mean;
  Matrix covariance;
};

/// Explanations with a probability of at least 1 %, probabilities summing to one.
std::vector<Forecast> forecast(const LinearModel& model, const Diagnosis& diagnosis, const Experiment& experiment,
                               const Options& options);

struct Proposal {
  std::size_t experiment = 0;
  double information = 0;    // expected drop of the entropy over explanations, nats
  double clear_verdict = 0;  // probability that one cause ends above options.name_above
};

/// All experiments, the best first: expected information about which explanation holds (Lindley 1956; Box and Hill
/// 1967), by `draws` simulated outcomes. Deterministic from the seed of the options.
std::vector<Proposal> propose(const LinearModel& model, const Diagnosis& diagnosis,
                              const std::vector<Experiment>& experiments, const Options& options, int draws = 120);

/// Probability of each effect once the experiment gave y.
std::vector<double> after_experiment(const std::vector<Forecast>& forecasts, const Vector& y, std::size_t effects);

}  // namespace calx::infer
