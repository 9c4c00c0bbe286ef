#include "infer/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace calx::infer {

Posterior weigh(const LinearModel& model, const Bank& bank, const Metric& metric, const Options& options) {
  Posterior posterior;
  const std::size_t count = model.effects.size();
  std::vector<Signature> signatures;
  std::vector<double> log_odds = {std::log(options.prior_none)};
  for (std::size_t e = 0; e < count; ++e) {
    signatures.push_back(whiten_signature(model, e, metric, options));
    posterior.fits.push_back(fit_single(signatures[e], metric));
    log_odds.push_back(posterior.fits[e].odds + std::log(options.prior_single / static_cast<double>(count)));
  }
  const std::size_t pair_start = log_odds.size();
  if (options.pairs)
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        PairModel pair{a, b, fit_pair(signatures[a], signatures[b], posterior.fits[a], posterior.fits[b], metric)};
        posterior.pairs.push_back(pair);
        log_odds.push_back(pair.fit.odds +
                           std::log(options.prior_pair / (0.5 * static_cast<double>(count * (count - 1)))));
      }
  if (options.unknown_rival) {
    posterior.discrepancy =
        fit_unknown(bank, whiten_bank(bank, model.observables, metric), model.observables.blocks.size(), metric);
    log_odds.push_back(posterior.discrepancy.odds + std::log(options.prior_unknown));
  }
  const double total = log_sum(log_odds);
  const auto probability = [&](std::size_t k) { return std::exp(log_odds[k] - total); };
  posterior.none = probability(0);
  for (std::size_t e = 0; e < count; ++e) posterior.single.push_back(probability(1 + e));
  posterior.inclusion = posterior.single;
  for (std::size_t k = 0; k < posterior.pairs.size(); ++k) {
    PairModel& pair = posterior.pairs[k];
    pair.probability = probability(pair_start + k);
    posterior.inclusion[pair.first] += pair.probability;
    posterior.inclusion[pair.second] += pair.probability;
  }
  if (options.unknown_rival) posterior.unknown = probability(log_odds.size() - 1);
  return posterior;
}

std::vector<std::size_t> credible_set(const Posterior& posterior, double share) {
  std::vector<double> p = posterior.inclusion;
  p.push_back(posterior.none);
  p.push_back(posterior.unknown);
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] > p[b]; });
  double sum = 0;
  std::size_t size = 0;
  while (size < order.size() && sum <= share) sum += p[order[size++]];
  order.resize(size);
  return order;
}

}  // namespace calx::infer
