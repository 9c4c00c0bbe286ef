#include "infer/experiment.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"

namespace calx::infer {

namespace {

constexpr double least_probability = 0.01;
constexpr double outside_spread = 3;  // of what an unknown effect may do to a new number, in its sd and tolerance

std::vector<double> updated(const std::vector<Forecast>& forecasts, const std::vector<Metric>& metrics,
                            const Vector& y) {
  std::vector<double> logs;
  for (std::size_t m = 0; m < forecasts.size(); ++m)
    logs.push_back(std::log(forecasts[m].probability) - 0.5 * (metrics[m].whiten(y - forecasts[m].mean)).squaredNorm() -
                   0.5 * metrics[m].log_determinant());
  const double total = log_sum(logs);
  for (double& l : logs) l = std::exp(l - total);
  return logs;
}

std::vector<Metric> metrics_of(const std::vector<Forecast>& forecasts) {
  std::vector<Metric> metrics;
  for (const Forecast& f : forecasts) metrics.emplace_back(f.covariance, f.mean);
  return metrics;
}

double entropy(const std::vector<double>& p) {
  double h = 0;
  for (double x : p) h -= x > 0 ? x * std::log(x) : 0;
  return h;
}

std::vector<double> inclusion(const std::vector<Forecast>& forecasts, const std::vector<double>& p,
                              std::size_t effects) {
  std::vector<double> out(effects, 0.0);
  for (std::size_t m = 0; m < forecasts.size(); ++m)
    for (std::size_t e : forecasts[m].effects) out[e] += p[m];
  return out;
}

}  // namespace

std::vector<Forecast> forecast(const LinearModel& model, const Diagnosis& diagnosis, const Experiment& experiment,
                               const Options& options) {
  const Posterior& posterior = diagnosis.posterior;
  const Budget& budget = diagnosis.budget;
  const View& view = options.stacking ? budget.both : budget.fit;
  const Vector r = view.y - model.base + model.sensitivities * model.u;
  std::vector<Forecast> out;
  const auto add = [&](const std::vector<Part>& parts, double probability, bool outside) {
    if (probability < least_probability) return;
    const Freedom freedom = freedom_of(model, parts, options);
    const auto p = model.sensitivities.cols() + freedom.columns.cols();
    Matrix old_columns(r.size(), p), new_columns(experiment.sd.size(), p);
    old_columns << model.sensitivities, freedom.columns;
    new_columns.leftCols(model.sensitivities.cols()) = experiment.sensitivities;
    Matrix noise = experiment.sd.cwiseAbs2().asDiagonal();
    const Vector& t = experiment.tolerance;
    noise += 0.5 * Matrix(t.cwiseAbs2().asDiagonal()) + 0.5 * t * t.transpose();
    Forecast f;
    auto column = model.sensitivities.cols();
    for (const Part& part : parts) {
      const Matrix& h = experiment.signatures[part.effect];
      const double scale = std::max(2 * model.effects[part.effect].scale, part.amplitude.norm());
      new_columns.middleCols(column, h.cols()) = scale * h;
      column += h.cols();
      const Vector change = part.shape_factor * options.shape * h * part.amplitude;
      noise += change * change.transpose();
      f.effects.push_back(part.effect);
    }
    const Matrix weighted = Eigen::LLT<Matrix>(budget.systematic + freedom.own + view.noise).solve(old_columns);
    const Matrix v = (old_columns.transpose() * weighted + Matrix::Identity(p, p)).inverse();
    f.outside = outside, f.probability = probability;
    f.mean = experiment.base - experiment.sensitivities * model.u + new_columns * (v * (weighted.transpose() * r));
    f.covariance = new_columns * v * new_columns.transpose() + noise;
    if (outside)
      f.covariance.diagonal() += outside_spread * outside_spread * (experiment.sd.cwiseAbs2() + t.cwiseAbs2());
    out.push_back(f);
  };
  add({}, posterior.none, false);
  add({}, posterior.unknown, true);
  for (std::size_t e = 0; e < posterior.single.size(); ++e)
    add({{e, posterior.fits[e].amplitude, posterior.fits[e].shape_factor}}, posterior.single[e], false);
  for (const PairModel& pair : posterior.pairs)
    add({{pair.first, pair.fit.first, posterior.fits[pair.first].shape_factor},
         {pair.second, pair.fit.second, posterior.fits[pair.second].shape_factor}},
        pair.probability, false);
  double total = 0;
  for (const Forecast& f : out) total += f.probability;
  for (Forecast& f : out) f.probability /= total;
  return out;
}

std::vector<double> after_experiment(const std::vector<Forecast>& forecasts, const Vector& y, std::size_t effects) {
  return inclusion(forecasts, updated(forecasts, metrics_of(forecasts), y), effects);
}

std::vector<Proposal> propose(const LinearModel& model, const Diagnosis& diagnosis,
                              const std::vector<Experiment>& experiments, const Options& options, int draws) {
  std::vector<Proposal> proposals;
  for (std::size_t x = 0; x < experiments.size(); ++x) {
    const std::vector<Forecast> forecasts = forecast(model, diagnosis, experiments[x], options);
    const std::vector<Metric> metrics = metrics_of(forecasts);
    std::vector<double> prior;
    for (const Forecast& f : forecasts) prior.push_back(f.probability);
    Random random(options.seed, 100 + x);
    Proposal proposal{x, 0, 0};
    for (std::size_t m = 0; m < forecasts.size(); ++m) {
      const int share = std::max(4, static_cast<int>(draws * forecasts[m].probability));
      const Eigen::LLT<Matrix> root(forecasts[m].covariance);
      double drop = 0, clear = 0;
      for (int k = 0; k < share; ++k) {
        Vector e(forecasts[m].mean.size());
        for (double& number : e) number = random.normal();
        const Vector y = forecasts[m].mean + root.matrixL() * e;
        const std::vector<double> p = updated(forecasts, metrics, y);
        drop += entropy(prior) - entropy(p);
        const std::vector<double> causes = inclusion(forecasts, p, model.effects.size());
        clear += *std::max_element(causes.begin(), causes.end()) > options.name_above ? 1 : 0;
      }
      proposal.information += forecasts[m].probability * drop / share;
      proposal.clear_verdict += forecasts[m].probability * clear / share;
    }
    proposals.push_back(proposal);
  }
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.information > b.information; });
  return proposals;
}

}  // namespace calx::infer
