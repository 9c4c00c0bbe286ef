// linearise.hpp: the model as a plane around a re-based fit: base mean, sensitivities, signatures.
#pragma once
#include <vector>

#include "infer/options.hpp"
#include "infer/seed_scatter.hpp"
#include "infer/simulator.hpp"

namespace calx::infer {

/// Observables near u are base + J (u' - u) + sum of amplitude * signature.
struct LinearModel {
  Observables observables;
  std::vector<Effect> effects;
  Vector u;                        // where it is linear, standardised
  Vector base;                     // mean over seeds
  Matrix sensitivities;            // one column per nuisance parameter, per prior sd
  std::vector<Matrix> signatures;  // per effect, a column per component, per unit of amplitude
  SeedScatter scatter;
  double common_numbers = 0;               // correlation of runs of one seed
  Vector partner;                          // what runs at u of the seed that all runs with effects share have in common
  double partner_weight = 1;               // variance of what it does not share with its seed, over that of one run
  Vector common_run;                       // run at u of that seed without effects
  Matrix base_columns;                     // runs of the last base pass, at u, a column each
  std::uint64_t base_seed = 0;             // of the first of them; the others follow
  std::vector<double> signature_variance;  // per effect, of a unit of amplitude over that of one run; 0: exact
  double base_weight = 1;                  // variance of the base mean over that of one run
  double sensitivity_weight = 0;           // variance of J (u' - u) over that of one run, at the posterior of u'
  int runs = 0;

  /// Response in a run of the partner's seed: the run less what the partner foretells of it, a control variate. Its
  /// noise covariance is response_variance times that of one run. Zero in blocks where the run is the one without
  /// effects, bit by bit, because the change cannot reach them.
  Vector response(const Vector& run) const { return response_to(run, partner, partner_weight, common_run); }
  double response_variance() const;
  /// The same for a run of another seed and the run of that seed without effects; variance of the mean of so many.
  Vector response(const Vector& run, const Vector& partner_run) const {
    return response_to(run, partner_run, 1, partner_run);
  }
  double response_variance(int seeds) const;

 private:
  /// Share of partner - base that a run of its seed is expected to show. weight: as partner_weight.
  double foretold(double weight) const;
  Vector response_to(const Vector& run, const Vector& shared, double weight, const Vector& own) const;
};

/// Number of runs of a plan, refinement included.
int planned_runs(const std::vector<Effect>& effects, int parameters, const Options& options);

/// Parameters drawn back to where the powder may be: what asks for more is likelier an effect, and its signature
/// belongs there.
Vector within_reach(const Vector& u, const Options& options);

/// Runs the simulator as planned: base runs with independent seeds before each fit of u to the campaign "fit", central
/// differences and one run per physical component of an effect with common random numbers. The mean surface wants
/// independent seeds and differences want common ones (Chen, Ankenman and Nelson 2012). Seeds follow from the seed of
/// the options. Effects with instrument = true cost no run.
LinearModel linearise(const Observables& observables, const std::vector<Effect>& effects, Simulator& simulator,
                      const Options& options);

}  // namespace calx::infer
