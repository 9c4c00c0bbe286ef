#include "infer/diagnosis.hpp"

#include <algorithm>
#include <cmath>

namespace calx::infer {

namespace {

struct Posed {
  Vector residual;
  Matrix covariance;  // with the nuisance parameters marginalised
};

Posed pose(const LinearModel& model, const Budget& budget, const View& view, const Options& options) {
  Posed posed;
  posed.residual = view.y - model.base;
  posed.covariance = budget.systematic + view.noise;
  if (options.recalibrate) {
    posed.residual += model.sensitivities * model.u;
    posed.covariance += model.sensitivities * model.sensitivities.transpose();
  }
  return posed;
}

Vector amplitude_of(const Posterior& posterior, const std::vector<std::size_t>& named, std::size_t effect) {
  for (const PairModel& pair : posterior.pairs)
    if (named.size() == 2 && pair.first == named[0] && pair.second == named[1])
      return effect == pair.first ? pair.fit.first : pair.fit.second;
  return posterior.fits[effect].amplitude;
}

std::vector<Vector> amplitudes_of(const Posterior& posterior, const std::vector<std::size_t>& named) {
  std::vector<Vector> out;
  for (std::size_t e : named) out.push_back(amplitude_of(posterior, named, e));
  return out;
}

/// Covariance that the named effects add: free amplitudes and uncertain shapes.
Matrix freed(const LinearModel& model, const std::vector<std::size_t>& named, const std::vector<Vector>& amplitudes,
             const Options& options) {
  Matrix c = Matrix::Zero(model.base.size(), model.base.size());
  for (std::size_t k = 0; k < named.size(); ++k) {
    const Matrix& g = model.signatures[named[k]];
    const double scale = std::max(2 * model.effects[named[k]].scale, amplitudes[k].norm());
    c += scale * scale * g * g.transpose();
    const Matrix b = shape_columns(model.observables, g * amplitudes[k], 1, options);
    c += b * b.transpose();
  }
  return c;
}

}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::named:
      return "named";
    case Verdict::unknown:
      return "unknown";
    default:
      return "ambiguous";
  }
}

Diagnosis diagnose(const LinearModel& model, const Bank& bank, const Options& options) {
  Diagnosis d;
  Budget budget = error_budget(model, options);
  d.events = screen(model, bank, budget.systematic, budget.fit, options);
  screen(model, bank, budget.systematic, budget.hold, options);
  budget.both = combine(budget.fit, budget.hold, model.observables);

  const Posed fit = pose(model, budget, budget.fit, options);
  d.fitted = weigh(model, bank, Metric(fit.covariance, fit.residual), options);
  const View& view = options.stacking ? budget.both : budget.fit;
  const Posed posed = options.stacking ? pose(model, budget, view, options) : fit;
  d.posterior = options.stacking ? weigh(model, bank, Metric(posed.covariance, posed.residual), options) : d.fitted;
  d.set = credible_set(d.posterior, 0.95);
  for (double p : d.posterior.inclusion) d.probability.push_back(options.calibration(p));

  d.before = check_fit(model, bank, posed.covariance - view.noise, view.noise, posed.residual, options, 1);
  d.after = d.before;
  const Posterior& p = d.posterior;
  for (std::size_t e = 0; e < p.inclusion.size(); ++e)
    if (p.inclusion[e] > options.name_above) d.named.push_back(e);
  if (d.named.size() > 2) d.named.clear();
  if (!d.named.empty()) {
    const std::vector<Vector> amplitudes = amplitudes_of(p, d.named);
    d.gain = held_out_gain(model, budget, d.named, amplitudes_of(d.fitted, d.named), options);
    const Matrix free = freed(model, d.named, amplitudes, options);
    d.after = check_fit(model, bank, posed.covariance - view.noise + free, view.noise, posed.residual, options, 2);
    if (d.after.p < options.fit_above) {
      d.verdict = Verdict::unknown;
      d.reason = "the best cause does not fit the data";
      d.named.clear();
    } else if (d.gain.log_score < options.gain_above) {
      d.verdict = Verdict::ambiguous;
      d.reason = "the best cause does not predict the held-out data";
      d.named.clear();
    } else {
      d.verdict = Verdict::named;
      d.reason = "probable, fits, and predicts the held-out data";
    }
  } else if (p.unknown > 0.5) {
    d.gain = held_out_gain(model, budget, bank.terms[p.discrepancy.term], p.discrepancy.strength, options);
    if (d.gain.log_score >= options.gain_above) {
      d.verdict = Verdict::unknown;
      d.reason = "a discrepancy outside the library predicts the held-out data";
    } else {
      d.verdict = Verdict::ambiguous;
      d.reason = "a discrepancy outside the library is not reproduced by the held-out data";
    }
  } else if (p.none > 0.5 || d.before.p > options.global_above) {
    d.verdict = Verdict::none;
    d.reason = "no discrepancy is shown";
  } else {
    d.verdict = Verdict::ambiguous;
    d.reason = "several explanations are left";
  }
  return d;
}

}  // namespace calx::infer
