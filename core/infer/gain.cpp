#include "infer/gain.hpp"

#include <cmath>

#include "infer/causes.hpp"

namespace calx::infer {

namespace {

struct Prediction {
  Vector mean;
  Matrix covariance;
};

/// Of held-out residuals: parameters a ~ N(0, I) act through `columns`; `own` is redrawn for each campaign.
Prediction predict(const LinearModel& model, const Budget& budget, const Matrix& columns, const Matrix& own) {
  const Vector r = budget.fit.y - model.base + model.sensitivities * model.u;
  const Eigen::LLT<Matrix> factor(budget.systematic + own + budget.fit.noise);
  const Matrix weighted = factor.solve(columns);
  const Matrix v = (columns.transpose() * weighted + Matrix::Identity(columns.cols(), columns.cols())).inverse();
  Prediction p;
  p.mean = columns * (v * (weighted.transpose() * r));
  p.covariance = columns * v * columns.transpose() + budget.systematic + own + budget.hold.noise;
  return p;
}

Gain compare(const LinearModel& model, const Budget& budget, const Matrix& columns, const Matrix& own) {
  const Prediction before = predict(model, budget, model.sensitivities, Matrix::Zero(own.rows(), own.cols()));
  Matrix all(columns.rows(), columns.cols() + model.sensitivities.cols());
  all << model.sensitivities, columns;
  const Prediction after = predict(model, budget, all, own);
  const Vector r = budget.hold.y - model.base + model.sensitivities * model.u;
  const Metric old_metric(before.covariance, r - before.mean), new_metric(after.covariance, r - after.mean);
  Gain gain;
  gain.log_score = new_metric.log_density() - old_metric.log_density();
  // With r ~ N(m1, V1): ln ratio = (z0^2 - |e|^2) / 2 + constant, e standard normal, z0 = L0^-1 (L1 e + m1 - m0).
  const Eigen::LLT<Matrix> root(after.covariance);
  const Matrix a = old_metric.whiten(Matrix(root.matrixL()));
  const Vector c = old_metric.whiten(after.mean - before.mean);
  const Matrix q = a.transpose() * a - Matrix::Identity(a.rows(), a.cols());
  gain.sd = std::sqrt(0.5 * q.squaredNorm() + (a.transpose() * c).squaredNorm());
  const Vector sd = model.observables.sd();
  double count = 0;
  for (int k = 0; k < r.size(); ++k) {
    if (budget.hold.noise(k, k) > 400 * sd[k] * sd[k]) continue;  // absent or screened
    gain.error_before += std::pow((r[k] - before.mean[k]) / sd[k], 2);
    gain.error_after += std::pow((r[k] - after.mean[k]) / sd[k], 2);
    count += 1;
  }
  if (count > 0)
    gain.error_before = std::sqrt(gain.error_before / count), gain.error_after = std::sqrt(gain.error_after / count);
  return gain;
}

}  // namespace

Freedom freedom_of(const LinearModel& model, const std::vector<Part>& parts, const Options& options) {
  const auto rows = model.base.size();
  Freedom freedom{Matrix(rows, 0), Matrix::Zero(rows, rows)};
  for (const Part& part : parts) {
    const Matrix& g = model.signatures[part.effect];
    const double scale = std::max(2 * model.effects[part.effect].scale, part.amplitude.norm());
    freedom.columns.conservativeResize(Eigen::NoChange, freedom.columns.cols() + g.cols());
    freedom.columns.rightCols(g.cols()) = scale * g;
    const Matrix b = shape_columns(model.observables, g * part.amplitude, 1, part.shape_factor, options);
    freedom.own += b * b.transpose();
    const Matrix noise = part.amplitude.norm() * noise_columns(model, part.effect, options);
    freedom.own += noise * noise.transpose();
  }
  return freedom;
}

Gain held_out_gain(const LinearModel& model, const Budget& budget, const std::vector<Part>& parts,
                   const Options& options) {
  const Freedom freedom = freedom_of(model, parts, options);
  return compare(model, budget, freedom.columns, freedom.own);
}

Gain held_out_gain(const LinearModel& model, const Budget& budget, const Term& term, double strength) {
  const auto rows = model.base.size();
  return compare(model, budget, strength * columns_of(term, model.observables), Matrix::Zero(rows, rows));
}

}  // namespace calx::infer
