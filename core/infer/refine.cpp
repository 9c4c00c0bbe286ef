#include <algorithm>
#include <numeric>

#include "infer/denoise.hpp"
#include "infer/diagnosis.hpp"

namespace calx::infer {

void refine(LinearModel& model, const Bank& bank, Simulator& simulator, const Options& options) {
  Options fast = options;
  fast.pairs = false, fast.unknown_rival = false;
  const Budget budget = error_budget(model, options);
  const View& view = options.stacking ? budget.both : budget.fit;
  const Matrix covariance = budget.systematic + view.noise + model.sensitivities * model.sensitivities.transpose();
  const Posterior posterior =
      weigh(model, bank, Metric(covariance, view.y - model.base + model.sensitivities * model.u), fast);

  const std::uint64_t common_seed = options.seed * 1000;
  std::vector<std::size_t> order(model.effects.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return posterior.fits[a].odds > posterior.fits[b].odds; });
  std::vector<RunPoint> points;
  std::vector<std::size_t> again;
  const auto correct = [&](std::size_t e, const Vector& response, double variance) {
    const Vector& a = posterior.fits[e].amplitude;
    const Vector curved = response - model.signatures[e] * a;
    const Vector change = variance > 0 ? Denoiser(model.observables, model.scatter)(curved, variance) : curved;
    model.signatures[e] += change * a.transpose() / a.squaredNorm();
  };
  for (std::size_t e : order) {
    const Vector& a = posterior.fits[e].amplitude;
    if (a.norm() < 0.02 * model.effects[e].scale) continue;
    const RunPoint point{model.u, static_cast<int>(e), a, common_seed};
    if (model.effects[e].instrument)
      correct(e, simulator.instrument(point), 0);
    else if (static_cast<int>(points.size()) < options.refined)
      points.push_back(point), again.push_back(e);
  }
  if (points.empty()) return;
  const Matrix runs = simulator.run(points);
  for (std::size_t k = 0; k < again.size(); ++k)
    correct(again[k], model.response(runs.col(static_cast<Eigen::Index>(k))), model.response_variance());
  model.runs += static_cast<int>(points.size());
}

}  // namespace calx::infer
