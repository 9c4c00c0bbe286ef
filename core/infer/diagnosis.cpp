#include "infer/diagnosis.hpp"

#include <algorithm>
#include <cmath>

namespace calx::infer {

std::vector<Part> parts_of(const Posterior& posterior, const std::vector<std::size_t>& named) {
  std::vector<Part> parts;
  for (std::size_t e : named) parts.push_back({e, posterior.fits[e].amplitude, posterior.fits[e].shape_factor});
  for (const PairModel& pair : posterior.pairs)
    if (named.size() == 2 && pair.first == named[0] && pair.second == named[1])
      parts[0].amplitude = pair.fit.first, parts[1].amplitude = pair.fit.second;
  return parts;
}

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
  Budget& budget = d.budget;
  budget = error_budget(model, options);
  d.events = screen(model, bank, budget.systematic, budget.fit, options);
  screen(model, bank, budget.systematic, budget.hold, options);
  budget.both = combine(budget.fit, budget.hold, model.observables);

  const Posed fit = pose(model, budget.systematic, budget.fit, options);
  d.fitted = weigh(model, bank, Metric(fit.covariance, fit.residual), options);
  const View& view = options.stacking ? budget.both : budget.fit;
  const Posed posed = options.stacking ? pose(model, budget.systematic, view, options) : fit;
  d.posterior = options.stacking ? weigh(model, bank, Metric(posed.covariance, posed.residual), options) : d.fitted;
  d.set = credible_set(d.posterior, 0.95);
  const bool none_is_left = std::find(d.set.begin(), d.set.end(), model.effects.size()) != d.set.end();
  for (double p : d.posterior.inclusion) d.probability.push_back(options.calibration(p));

  d.before = check_fit(model, bank, posed.covariance - view.noise, view.noise, posed.residual, options, 1);
  d.after = d.before;
  const Posterior& p = d.posterior;
  for (std::size_t e = 0; e < p.inclusion.size(); ++e)
    if (p.inclusion[e] > options.name_above && d.fitted.inclusion[e] > options.fitted_above) d.named.push_back(e);
  if (d.named.size() > 2) d.named.clear();
  if (!d.named.empty()) {
    d.gain = held_out_gain(model, budget, parts_of(d.fitted, d.named), options);
    // Of two, each must earn its place beside the other; else the better one is left to stand alone.
    if (d.named.size() == 2) {
      const Gain first = held_out_gain(model, budget, parts_of(d.fitted, {d.named[0]}), options),
                 second = held_out_gain(model, budget, parts_of(d.fitted, {d.named[1]}), options);
      const bool first_leads = first.log_score >= second.log_score;
      const Gain& better = first_leads ? first : second;
      if (d.gain.log_score - better.log_score < options.partner_above) {
        d.named = {d.named[first_leads ? 0 : 1]};
        d.gain = better;
      }
    }
    const Freedom freedom = freedom_of(model, parts_of(p, d.named), options);
    const Matrix free = freedom.columns * freedom.columns.transpose() + freedom.own;
    d.after = check_fit(model, bank, posed.covariance - view.noise + free, view.noise, posed.residual, options, 2);
    if (d.after.p < options.fit_above) {
      d.verdict = Verdict::unknown;
      d.reason = "the best cause does not fit the data";
      d.refused.swap(d.named);
    } else if (d.gain.log_score < options.gain_above) {
      d.verdict = Verdict::ambiguous;
      d.reason = "the best cause does not predict the held-out data";
      d.named.clear();
    } else {
      d.verdict = Verdict::named;
      d.reason = "probable, fits, and predicts the held-out data";
    }
  } else if (p.unknown > options.unknown_above) {
    d.gain = held_out_gain(model, budget, bank.terms[p.discrepancy.term], p.discrepancy.strength);
    if (d.gain.log_score >= options.gain_above) {
      d.verdict = Verdict::unknown;
      d.reason = "a discrepancy outside the library predicts the held-out data";
    } else {
      d.verdict = Verdict::ambiguous;
      d.reason = "a discrepancy outside the library is not reproduced by the held-out data";
    }
  } else if (p.none > 0.5 || (d.before.p > options.global_above && none_is_left)) {
    d.verdict = Verdict::none;
    d.reason = "no discrepancy is shown";
  } else {
    d.verdict = Verdict::ambiguous;
    d.reason = "several explanations are left";
  }
  return d;
}

void calibrate(Diagnosis& d, const Options& options) {
  for (std::size_t e = 0; e < d.probability.size(); ++e)
    d.probability[e] = options.calibration(d.posterior.inclusion[e]);
  const auto doubted = [&](std::size_t e) { return d.probability[e] <= options.name_above; };
  if (std::any_of(d.refused.begin(), d.refused.end(), doubted)) d.refused.clear();
  if (std::none_of(d.named.begin(), d.named.end(), doubted)) return;
  d.verdict = Verdict::ambiguous;
  d.reason = "the best cause is not probable enough once the self-test has corrected what is stated";
  d.named.clear();
}

}  // namespace calx::infer
