#include "infer/linearise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "infer/budget.hpp"
#include "infer/denoise.hpp"

namespace calx::infer {

namespace {

constexpr double pi = 3.14159265358979323846;
// With fewer runs of one seed their median says no more of it than the run without effects.
constexpr Eigen::Index least_shared = 6;
constexpr int shared_passes = 2;
constexpr std::uint64_t slope_seeds = 800;  // after the seeds of the base
// Beyond so many times the scatter of runs without an effect, or where some cannot be made, runs with it tell nothing
// of one direction of a vector: a case may not hold its powder together in every direction.
constexpr double wild = 25;

std::vector<RunPoint> base_points(const Vector& u, int count, std::uint64_t& seed) {
  std::vector<RunPoint> points;
  for (int k = 0; k < count; ++k) points.push_back({u, -1, {}, seed++});
  return points;
}

/// Most effects leave most numbers alone, so that the median of all runs of a seed is what they have in common, even
/// where one signature is still wrong. Its variance is pi / 2 of that of a mean.
Vector row_median(const Matrix& runs) {
  Vector median(runs.rows());
  for (Eigen::Index k = 0; k < runs.rows(); ++k) {
    Vector row = runs.row(k).transpose();
    const Eigen::Index half = row.size() / 2;
    std::nth_element(row.begin(), row.begin() + half, row.end());
    const double upper = row[half];
    median[k] = row.size() % 2 == 1 ? upper : 0.5 * (upper + *std::max_element(row.begin(), row.begin() + half));
  }
  return median;
}

/// Most probable correlation of runs of one seed, for the model's partner and the runs with a change.
double estimate_common(const Denoiser& denoise, const std::vector<Vector>& changed, LinearModel& model) {
  double best = 0, best_evidence = -1e300;
  for (double rho : {0.0, 0.3, 0.5, 0.65, 0.8, 0.9, 0.95, 0.99}) {
    model.common_numbers = rho;
    double evidence = 0;
    for (const Vector& run : changed) denoise(model.response(run), model.response_variance(), &evidence);
    if (evidence > best_evidence) best = rho, best_evidence = evidence;
  }
  return best;
}

}  // namespace

Vector within_reach(const Vector& u, const Options& options) {
  return u.cwiseMax(-options.reach).cwiseMin(options.reach);
}

double LinearModel::foretold(double weight) const {
  return common_numbers <= 0 ? 0 : common_numbers / (common_numbers + (1 - common_numbers) * weight);
}

Vector LinearModel::response_to(const Vector& run, const Vector& shared, double weight, const Vector& own) const {
  Vector out = run - base - foretold(weight) * (shared - base);
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const int first = observables.first(b), n = observables.size(b);
    if (run.segment(first, n) == own.segment(first, n)) out.segment(first, n).setZero();
  }
  return out;
}

double LinearModel::response_variance() const {
  const double share = foretold(partner_weight);
  return 1 - share * common_numbers + (1 - share) * (1 - share) * base_weight;
}

double LinearModel::response_variance(int seeds) const {
  const double rho = common_numbers;
  return (1 - rho * rho) / seeds + (1 - rho) * (1 - rho) * base_weight;
}

int planned_runs(const std::vector<Effect>& effects, int parameters, const Options& options) {
  int runs = 1 + 2 * parameters * options.slope_runs + options.refined;
  for (int n : options.base_runs) runs += n;
  for (const Effect& effect : effects) runs += effect.instrument ? 0 : effect.components * options.effect_runs;
  return runs;
}

LinearModel linearise(const Observables& observables, const std::vector<Effect>& effects, Simulator& simulator,
                      const Options& options) {
  observables.check();
  LinearModel model;
  model.observables = observables, model.effects = effects;
  const int p = simulator.parameters(), rows = observables.rows();
  std::uint64_t seed = options.seed * 1000 + 1;
  const std::uint64_t common_seed = options.seed * 1000;
  model.u = Vector::Zero(p);
  std::vector<Matrix> groups;
  std::vector<Vector> places;
  Matrix differences(rows, p);  // raw
  model.sensitivities = Matrix::Zero(rows, p);
  Vector moved = Vector::Ones(p), steps(p);  // moved: expected square of u' - u
  for (int k = 0; k < p; ++k) steps[k] = simulator.step(k);
  // Variance of half the difference of two runs of one seed over the step, in variances of a run.
  const auto slope_variance = [&](double rho, int k) {
    return (1 - rho) / (2 * steps[k] * steps[k] * options.slope_runs);
  };
  const auto slope_weight = [&](double rho) {
    return (1 - rho) / (2 * options.slope_runs) * moved.cwiseQuotient(steps.cwiseAbs2()).sum();
  };

  for (std::size_t pass = 0; pass < options.base_runs.size(); ++pass) {
    model.base_seed = seed;
    groups.push_back(simulator.run(base_points(model.u, options.base_runs[pass], seed)));
    model.base_columns = groups.back();
    places.push_back(model.u);
    model.scatter = estimate_scatter(observables, groups);
    if (pass == 0) {
      std::vector<RunPoint> points;
      for (int k = 0; k < p; ++k)
        for (int s = 0; s < options.slope_runs; ++s)
          for (double sign : {1.0, -1.0}) {
            points.push_back({model.u, -1, {}, s == 0 ? common_seed : common_seed + slope_seeds + s});
            points.back().u[k] += sign * steps[k];
          }
      const Matrix runs = simulator.run(points);
      const Denoiser denoise(observables, model.scatter);
      const double rho = options.common_numbers < 0 ? 0.5 : options.common_numbers;
      for (int k = 0; k < p; ++k) {
        differences.col(k).setZero();
        for (int s = 0; s < options.slope_runs; ++s) {
          const Eigen::Index pair = 2 * (k * options.slope_runs + s);
          differences.col(k) += (runs.col(pair) - runs.col(pair + 1)) / (2 * steps[k] * options.slope_runs);
        }
        model.sensitivities.col(k) = denoise(differences.col(k), slope_variance(rho, k));
      }
    }
    // Earlier groups are carried here by the sensitivities, and weigh the less the farther away they are.
    Vector sum = Vector::Zero(rows);
    double weight = 0, square = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double count = static_cast<double>(groups[g].cols()), near = (model.u - places[g]).squaredNorm();
      const double w = count / (1 + count * near);
      sum += w * (groups[g].rowwise().mean() + model.sensitivities * (model.u - places[g]));
      weight += w, square += w * w / count;
    }
    model.base = sum / weight;
    model.base_weight = square / (weight * weight);
    model.sensitivity_weight = slope_weight(0.5);
    const Budget budget = error_budget(model, options);
    const NuisanceFit fit = fit_nuisance(model, budget, options);
    moved = (fit.u - model.u).cwiseAbs2() + fit.covariance.diagonal();
    if (pass + 1 < options.base_runs.size()) model.u = within_reach(fit.u, options);
  }

  std::vector<RunPoint> points = {{model.u, -1, {}, common_seed}};
  for (std::size_t e = 0; e < effects.size(); ++e)
    for (int c = 0; c < effects[e].components && !effects[e].instrument; ++c)
      points.push_back({model.u, static_cast<int>(e),
                        options.step_scales * effects[e].scale * Vector::Unit(effects[e].components, c), common_seed});
  const Matrix runs = simulator.run(points);
  std::vector<Vector> changed;
  // An effect that cannot be run leaves no signature.
  for (int k = 1; k < runs.cols(); ++k) changed.push_back(runs.col(k).allFinite() ? runs.col(k) : runs.col(0));
  const Denoiser denoise(observables, model.scatter);
  model.partner = model.common_run = runs.col(0);
  Matrix without = runs;  // effects, as far as they are known, taken out
  model.common_numbers =
      options.common_numbers >= 0 ? options.common_numbers : estimate_common(denoise, changed, model);
  const double rho = model.common_numbers;
  const auto clean = [&] {
    std::vector<Vector> responses;
    for (const Vector& run : changed) responses.push_back(denoise(model.response(run), model.response_variance()));
    return responses;
  };
  std::vector<Vector> responses = clean();
  for (int pass = 0; pass < shared_passes && runs.cols() >= least_shared; ++pass) {
    for (std::size_t k = 0; k < changed.size(); ++k)
      without.col(static_cast<Eigen::Index>(k) + 1) = changed[k] - responses[k];
    model.partner = row_median(without);
    model.partner_weight = 0.5 * pi / static_cast<double>(without.cols());
    responses = clean();
  }
  // Seeds after the first are those of the last base runs, at the same place, which are their partners.
  const int seeds = std::min(options.effect_runs, 1 + static_cast<int>(model.base_columns.cols()));
  if (seeds > 1 && !changed.empty()) {
    std::vector<RunPoint> more;
    for (int s = 1; s < seeds; ++s)
      for (std::size_t k = 1; k < points.size(); ++k) {
        more.push_back(points[k]);
        more.back().seed = model.base_seed + static_cast<std::uint64_t>(s - 1);
      }
    const Matrix again = simulator.run(more);
    const auto count = static_cast<Eigen::Index>(changed.size());
    const Vector scatter = model.scatter.covariance(observables).diagonal();
    for (Eigen::Index k = 0; k < count; ++k) {
      // A run that could not be made counts for nothing, unlike one that changed nothing.
      std::vector<Vector> made;
      if (runs.col(k + 1).allFinite()) made.push_back(model.response(runs.col(k + 1)));
      for (int s = 1; s < seeds; ++s) {
        const Vector run = again.col((s - 1) * count + k);
        if (run.allFinite()) made.push_back(model.response(run, model.base_columns.col(s - 1)));
      }
      if (made.empty()) continue;
      Vector mean = Vector::Zero(rows);
      for (const Vector& one : made) mean += one / static_cast<double>(made.size());
      double apart = 0;
      for (const Vector& one : made) apart += (one - mean).cwiseAbs2().cwiseQuotient(scatter).mean();
      const bool vector =
          effects[static_cast<std::size_t>(points[static_cast<std::size_t>(k) + 1].effect)].components > 1;
      responses[static_cast<std::size_t>(k)] =
          vector && (static_cast<int>(made.size()) < seeds || apart > wild * static_cast<double>(made.size() - 1))
              ? Vector(Vector::Zero(rows))
              : denoise(mean, model.response_variance(static_cast<int>(made.size())));
    }
  }
  const double variance = seeds > 1 ? model.response_variance(seeds) : model.response_variance();
  std::size_t next = 0;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    Matrix columns(rows, effects[e].components);
    for (int c = 0; c < effects[e].components; ++c) {
      const double amplitude = options.step_scales * effects[e].scale;
      if (effects[e].instrument) {
        const RunPoint point{model.u, static_cast<int>(e), amplitude * Vector::Unit(effects[e].components, c),
                             common_seed};
        columns.col(c) = simulator.instrument(point) / amplitude;
      } else {
        columns.col(c) = responses[next++] / amplitude;
      }
    }
    model.signatures.push_back(columns);
    const double step_size = options.step_scales * effects[e].scale;
    model.signature_variance.push_back(effects[e].instrument ? 0 : variance / (step_size * step_size));
  }
  for (int k = 0; k < p; ++k) model.sensitivities.col(k) = denoise(differences.col(k), slope_variance(rho, k));
  model.sensitivity_weight = slope_weight(rho);
  model.runs = planned_runs(effects, p, options) - options.refined;
  return model;
}

}  // namespace calx::infer
