#include "infer/budget.hpp"

#include <algorithm>
#include <cmath>

namespace calx::infer {

namespace {

constexpr double absent = 1e3;              // sd of a row without a number, in declared sd
constexpr double correlation_error = 0.15;  // of a declared autocorrelation
constexpr double tail_weight =
    0.25;  // information of a squared heavy-tailed number (t with 5 degrees) over a normal one

View campaign(const LinearModel& model, const MeasurementNoise& noise, bool hold) {
  const Observables& all = model.observables;
  View view{model.base, Matrix::Zero(all.rows(), all.rows())};
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const Block& block = all.blocks[b];
    const int first = all.first(b), n = all.size(b);
    const Vector& y = hold ? block.hold : block.fit;
    const Vector sd = (y.size() == 0 ? absent : noise.factor[b]) * block.sd;
    view.noise.block(first, first, n, n) =
        sd.asDiagonal() * autocorrelation_matrix(n, y.size() == 0 ? 0 : noise.autocorrelation[b]) * sd.asDiagonal();
    if (y.size() != 0) view.y.segment(first, n) = y;
  }
  return view;
}

}  // namespace

MeasurementNoise estimate_noise(const Observables& observables, const Options& options) {
  MeasurementNoise noise;
  // A relative error e of a declared sd is worth 1 / (2 e^2) squared numbers.
  const double prior = 1 / (2 * options.declared_error * options.declared_error);
  for (const Block& block : observables.blocks) {
    double factor = 1, correlation = block.autocorrelation;
    if (block.fit.size() != 0 && block.hold.size() != 0) {
      const Vector z = (block.fit - block.hold).cwiseQuotient(std::sqrt(2.0) * block.sd);
      const double n = static_cast<double>(z.size());
      factor = std::sqrt((prior + tail_weight * z.squaredNorm()) / (prior + tail_weight * n));
      if (n >= 12 && z.squaredNorm() > 0) {
        const double seen = z.head(z.size() - 1).dot(z.tail(z.size() - 1)) / z.squaredNorm();
        const double declared_weight = 1 / (correlation_error * correlation_error);
        correlation = (declared_weight * correlation + n * seen) / (declared_weight + n);
        correlation = std::clamp(correlation, -0.9, 0.9);
      }
    }
    noise.factor.push_back(factor);
    noise.autocorrelation.push_back(correlation);
  }
  return noise;
}

View combine(const View& a, const View& b, const Observables& observables) {
  View view{a.y, a.noise};
  for (std::size_t k = 0; k < observables.blocks.size(); ++k) {
    const int first = observables.first(k), n = observables.size(k);
    const Matrix ca = a.noise.block(first, first, n, n), cb = b.noise.block(first, first, n, n);
    const Matrix gain = (ca + cb).ldlt().solve(ca).transpose();  // ca (ca + cb)^-1
    view.y.segment(first, n) += gain * (b.y - a.y).segment(first, n);
    const Matrix c = ca - gain * ca;
    view.noise.block(first, first, n, n) = 0.5 * (c + c.transpose());
  }
  return view;
}

Budget error_budget(const LinearModel& model, const Options& options) {
  const Observables& all = model.observables;
  Budget budget;
  budget.systematic = Matrix::Zero(all.rows(), all.rows());
  const Matrix scatter = model.scatter.covariance(all);
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const int first = all.first(b), n = all.size(b);
    const Vector& sd = all.blocks[b].sd;
    const double base_sd = all.blocks[b].base_sd;
    if (options.seed_scatter)
      budget.systematic.block(first, first, n, n) =
          ((base_sd < 0 ? model.base_weight : 0) + model.sensitivity_weight) * scatter.block(first, first, n, n);
    if (base_sd > 0)
      budget.systematic.block(first, first, n, n) += base_sd * base_sd * Matrix(sd.cwiseAbs2().asDiagonal());
    Matrix bias = Matrix::Ones(1, 1);
    if (n > 1) bias = 0.5 * Matrix::Identity(n, n) + 0.5 * smooth_kernel(all.blocks[b], 0.25);
    const Matrix constant = 0.5 * (Matrix::Ones(n, n) + bias);
    const double declared = all.blocks[b].tolerance, tolerance = declared < 0 ? options.tolerance : declared;
    budget.systematic.block(first, first, n, n) +=
        sd.asDiagonal() * (tolerance * tolerance * bias + options.numerical * options.numerical * constant) *
        sd.asDiagonal();
  }
  const MeasurementNoise noise = estimate_noise(all, options);
  budget.fit = campaign(model, noise, false), budget.hold = campaign(model, noise, true);
  budget.both = combine(budget.fit, budget.hold, all);
  return budget;
}

Posed pose(const LinearModel& model, const Matrix& systematic, const View& view, const Options& options) {
  Posed posed;
  posed.residual = view.y - model.base;
  posed.covariance = systematic + view.noise;
  if (options.recalibrate) {
    posed.residual += model.sensitivities * model.u;
    posed.covariance += model.sensitivities * model.sensitivities.transpose();
  }
  return posed;
}

NuisanceFit fit_nuisance(const LinearModel& model, const Budget& budget, const Options& options) {
  const auto p = model.u.size();
  if (!options.recalibrate) return {Vector::Zero(p), Matrix::Identity(p, p)};
  const Eigen::LLT<Matrix> s(budget.systematic + budget.fit.noise);
  const Vector r = budget.fit.y - model.base + model.sensitivities * model.u;
  const Matrix weighted = s.solve(model.sensitivities);
  const Matrix precision = model.sensitivities.transpose() * weighted + Matrix::Identity(p, p);
  NuisanceFit fit;
  fit.covariance = precision.inverse();
  fit.u = fit.covariance * (weighted.transpose() * r);
  return fit;
}

}  // namespace calx::infer
