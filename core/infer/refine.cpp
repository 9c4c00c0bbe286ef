#include <algorithm>
#include <numeric>

#include "infer/diagnosis.hpp"

namespace calx::infer {

namespace {

constexpr double clear = 10;  // signal over noise at which the response of a run is worth seeing

}  // namespace

void refine(LinearModel& model, const Bank& bank, Simulator& simulator, const Options& options) {
  Options fast = options;
  fast.pairs = false, fast.unknown_rival = false;
  const Budget budget = error_budget(model, options);
  const View& view = options.stacking ? budget.both : budget.fit;
  const Matrix covariance = budget.systematic + view.noise + model.sensitivities * model.sensitivities.transpose();
  const std::uint64_t common_seed = options.seed * 1000;
  const Metric metric(covariance, view.y - model.base + model.sensitivities * model.u);
  const Posterior posterior = weigh(model, bank, metric, fast);
  std::vector<std::size_t> order(model.effects.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return posterior.fits[a].odds > posterior.fits[b].odds; });
  std::vector<RunPoint> points;
  for (std::size_t e : order) {
    const Effect& effect = model.effects[e];
    Vector a = posterior.fits[e].amplitude;
    if (a.norm() < 0.02 * effect.scale) continue;
    RunPoint point{model.u, static_cast<int>(e), a, common_seed};
    if (effect.instrument) {
      const Vector curved = simulator.instrument(point) - model.signatures[e] * a;
      model.signatures[e] += curved * a.transpose() / a.squaredNorm();
    } else if (static_cast<int>(points.size()) < options.refined) {
      // Small responses drown in the scatter of the run.
      const double seen = metric.whiten(model.signatures[e] * a).norm(), first = options.step_scales * effect.scale;
      if (seen < clear) a *= std::clamp(first / a.norm(), 1.0, clear / std::max(seen, 1e-9));
      point.amplitude = a;
      points.push_back(point);
    }
  }
  if (points.empty()) return;
  const Matrix runs = simulator.run(points);
  // Runs that do not scatter at all would leave nothing to divide by.
  const Eigen::LLT<Matrix> scatter(model.scatter.covariance(model.observables) +
                                   Matrix((1e-3 * model.observables.sd()).cwiseAbs2().asDiagonal()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto e = static_cast<std::size_t>(points[k].effect);
    const Vector& a = points[k].amplitude;
    const Vector straight = model.signatures[e] * a;
    const Vector curved = model.response(runs.col(static_cast<Eigen::Index>(k))) - straight;
    // Both runs scatter, the first one carried to this amplitude.
    const double ratio = a.norm() / (options.step_scales * model.effects[e].scale),
                 variance = model.response_variance() * (1 + ratio * ratio);
    const Matrix shape = shape_columns(model.observables, straight, 1, 1, options);
    if (shape.cols() == 0) continue;
    const Matrix weighted = scatter.solve(shape) / variance;
    const Matrix precision = shape.transpose() * weighted + Matrix::Identity(shape.cols(), shape.cols());
    const Vector change = shape * precision.ldlt().solve(weighted.transpose() * curved);
    model.signatures[e] += change * a.transpose() / a.squaredNorm();
  }
  model.runs += static_cast<int>(points.size());
}

}  // namespace calx::infer
