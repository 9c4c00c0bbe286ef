// budget.hpp: the error budget of a comparison of model and measurement, and the fit of nuisance parameters under it.
#pragma once
#include "infer/linearise.hpp"

namespace calx::infer {

/// Measurement noise as declared, corrected by what two campaigns at equal conditions show: their difference holds
/// nothing but noise. One factor on the sd and one lag-one correlation per block.
struct MeasurementNoise {
  std::vector<double> factor, autocorrelation;
};

MeasurementNoise estimate_noise(const Observables& observables, const Options& options);

/// One view of the data: numbers, with the covariance of their measurement noise. Rows without a number carry the base
/// mean and a variance beyond every effect, so that all views have the same rows.
struct View {
  Vector y;
  Matrix noise;
};

struct Budget {
  Matrix systematic;     // seed scatter, numerical, tolerance, noise of sensitivities: shared by all campaigns
  View fit, hold, both;  // both: the precision-weighted mean of the campaigns
};

/// Follows Kennedy and O'Hagan (2001), with the discrepancy held to a declared tolerance. Fails like
/// Observables::check.
Budget error_budget(const LinearModel& model, const Options& options);

/// The mean of two campaigns of one quantity, each weighed by the inverse of its covariance.
View combine(const View& a, const View& b, const Observables& observables);

/// Residual of a view, free of nuisance parameters: they are marginalised, unless the options keep them at zero.
struct Posed {
  Vector residual;
  Matrix covariance;
};
Posed pose(const LinearModel& model, const Matrix& systematic, const View& view, const Options& options);

struct NuisanceFit {
  Vector u;           // posterior mean given the campaign "fit", standardised
  Matrix covariance;  // posterior
};

NuisanceFit fit_nuisance(const LinearModel& model, const Budget& budget, const Options& options);

}  // namespace calx::infer
