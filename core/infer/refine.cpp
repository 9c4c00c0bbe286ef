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
  // Seeds after the first are those of the base runs at the same place, which are their partners.
  const int seeds = std::min(options.refined_runs, 1 + static_cast<int>(model.base_columns.cols()));
  std::vector<RunPoint> points;
  std::vector<std::size_t> again;
  const auto correct = [&](std::size_t e, const Vector& response, double variance) {
    const Vector& a = posterior.fits[e].amplitude;
    const Vector curved = response - model.signatures[e] * a;
    const Vector change = variance > 0 ? Denoiser(model.observables, model.scatter)(curved, variance) : curved;
    model.signatures[e] += change * a.transpose() / a.squaredNorm();
    model.signature_variance[e] = std::min(model.signature_variance[e], variance / a.squaredNorm());
  };
  for (std::size_t e : order) {
    const Vector& a = posterior.fits[e].amplitude;
    if (a.norm() < 0.02 * model.effects[e].scale) continue;
    const RunPoint point{model.u, static_cast<int>(e), a, common_seed};
    if (model.effects[e].instrument)
      correct(e, simulator.instrument(point), 0);
    else if (static_cast<int>(again.size()) < options.refined) {
      points.push_back(point), again.push_back(e);
      for (int s = 1; s < seeds; ++s) {
        points.push_back(point);
        points.back().seed = model.base_seed + static_cast<std::uint64_t>(s - 1);
      }
    }
  }
  if (points.empty()) return;
  const Matrix runs = simulator.run(points);
  Eigen::Index column = 0;
  for (const std::size_t e : again) {
    // What cannot be run at its fitted amplitude keeps the signature it has.
    if (!runs.middleCols(column, seeds).allFinite()) {
      column += seeds;
      continue;
    }
    Vector response = Vector::Zero(model.base.size());
    for (int s = 0; s < seeds; ++s, ++column) {
      const Vector partner = s == 0 ? model.partner : Vector(model.base_columns.col(s - 1));
      response += model.response(runs.col(column), partner) / seeds;
    }
    correct(e, response, model.response_variance(seeds));
  }
  model.runs += static_cast<int>(points.size());
}

void rebase(LinearModel& model, const Vector& u, int seeds, Simulator& simulator, const Options& options) {
  const std::uint64_t first = model.base_seed + static_cast<std::uint64_t>(model.base_columns.cols());
  std::vector<RunPoint> points = {{u, -1, {}, options.seed * 1000}};
  for (int s = 0; s < seeds; ++s) points.push_back({u, -1, {}, first + static_cast<std::uint64_t>(s)});
  const Matrix runs = simulator.run(points);
  // As in linearise: what was known counts the less the farther away it was learnt.
  const double near = (u - model.u).squaredNorm(), old = 1 / (model.base_weight + near), count = seeds;
  model.base_columns = runs.rightCols(seeds);
  model.base =
      (old * (model.base + model.sensitivities * (u - model.u)) + count * model.base_columns.rowwise().mean()) /
      (old + count);
  model.base_weight = (old * old * model.base_weight + count) / ((old + count) * (old + count));
  model.partner = runs.col(0);
  model.base_seed = first;
  model.u = u;
  model.runs += 1 + seeds;
}

}  // namespace calx::infer
