#include <algorithm>
#include <numeric>

#include "infer/denoise.hpp"
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
  const std::uint64_t common_seed = options.seed * 1000;
  const Posed posed = pose(model, budget.systematic, view, options);
  const Metric metric(posed.covariance, posed.residual);
  const Posterior posterior = weigh(model, bank, metric, fast);
  std::vector<std::size_t> order(model.effects.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return posterior.fits[a].odds > posterior.fits[b].odds; });
  // Seeds after the first are those of the base runs at the same place, which are their partners.
  const int seeds = std::min(options.refined_runs, 1 + static_cast<int>(model.base_columns.cols()));
  std::vector<RunPoint> points;
  std::vector<std::size_t> again;
  std::vector<Vector> amplitudes;
  for (std::size_t e : order) {
    const Effect& effect = model.effects[e];
    Vector a = posterior.fits[e].amplitude;
    if (a.norm() < 0.02 * effect.scale) continue;
    RunPoint point{model.u, static_cast<int>(e), a, common_seed};
    if (effect.instrument) {
      const Vector curved = simulator.instrument(point) - model.signatures[e] * a;
      model.signatures[e] += curved * a.transpose() / a.squaredNorm();
    } else if (static_cast<int>(again.size()) < options.refined) {
      // Small responses drown in the scatter of the run.
      const double seen = metric.whiten(model.signatures[e] * a).norm(), first = options.step_scales * effect.scale;
      if (seen < clear) a *= std::clamp(first / a.norm(), 1.0, clear / std::max(seen, 1e-9));
      point.amplitude = a;
      points.push_back(point), again.push_back(e), amplitudes.push_back(a);
      for (int s = 1; s < seeds; ++s) {
        points.push_back(point);
        points.back().seed = model.base_seed + static_cast<std::uint64_t>(s - 1);
      }
    }
  }
  if (points.empty()) return;
  const Matrix runs = simulator.run(points);
  // Runs that do not scatter at all would leave nothing to divide by.
  const Eigen::LLT<Matrix> scatter(model.scatter.covariance(model.observables) +
                                   Matrix((1e-3 * model.observables.sd()).cwiseAbs2().asDiagonal()));
  for (std::size_t k = 0; k < again.size(); ++k) {
    const std::size_t e = again[k];
    const Vector& a = amplitudes[k];
    const Matrix own = runs.middleCols(static_cast<Eigen::Index>(k) * seeds, seeds);
    // What cannot be run at this amplitude keeps the signature it has.
    if (!own.allFinite()) continue;
    const Vector straight = model.signatures[e] * a;
    Vector change;
    double variance = model.response_variance();
    if (seeds == 1) {
      const Vector curved = model.response(own.col(0)) - straight;
      // Both runs scatter, the first one carried to this amplitude.
      const double ratio = a.norm() / (options.step_scales * model.effects[e].scale),
                   both = variance * (1 + ratio * ratio);
      const Matrix shape = shape_columns(model.observables, straight, 1, 1, options);
      if (shape.cols() == 0) continue;
      const Matrix weighted = scatter.solve(shape) / both;
      const Matrix precision = shape.transpose() * weighted + Matrix::Identity(shape.cols(), shape.cols());
      change = shape * precision.ldlt().solve(weighted.transpose() * curved);
    } else {
      // Several runs speak for themselves, whatever the shape was held to be.
      Vector response = Vector::Zero(model.base.size());
      for (int s = 0; s < seeds; ++s)
        response +=
            (s == 0 ? model.response(own.col(0)) : model.response(own.col(s), model.base_columns.col(s - 1))) / seeds;
      variance = model.response_variance(seeds);
      change = Denoiser(model.observables, model.scatter)(response - straight, variance);
    }
    model.signatures[e] += change * a.transpose() / a.squaredNorm();
    model.signature_variance[e] = std::min(model.signature_variance[e], variance / a.squaredNorm());
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
  model.partner = model.common_run = runs.col(0);
  model.partner_weight = 1;
  model.base_seed = first;
  model.u = u;
  model.runs += 1 + seeds;
}

}  // namespace calx::infer
