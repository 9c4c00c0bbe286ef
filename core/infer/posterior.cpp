#include "infer/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace calx::infer {

namespace {

constexpr double least_share = 1e-9;  // of a term that an effect imitates exactly; keeps its logarithm finite

/// Log share of each term that no effect has: what an effect imitates to within the noise is that effect, not something
/// outside the library, and is not counted twice. With d the distance of the fitted term to its best imitation and s
/// its size, both in sd: (1 - exp(-d^2 / 2)) / (1 - exp(-s^2 / 2)). Terms of several columns keep all.
std::vector<double> log_distinct(const std::vector<Matrix>& terms, const std::vector<Signature>& signatures,
                                 const Metric& metric) {
  std::vector<Matrix> inverses;
  for (const Signature& s : signatures) inverses.push_back(s.columns.completeOrthogonalDecomposition().pseudoInverse());
  std::vector<double> out(terms.size(), 0);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k].cols() > 1) continue;
    const Vector column = terms[k].col(0), seen = column * (column.dot(metric.residual()) / column.squaredNorm());
    const double size = seen.squaredNorm();
    if (!(size > 0)) continue;
    double nearest = size;
    for (std::size_t e = 0; e < signatures.size(); ++e) {
      const Vector amplitude = inverses[e] * seen;
      if (signatures[e].one_sided && amplitude[0] < 0) continue;
      nearest = std::min(nearest, (seen - signatures[e].columns * amplitude).squaredNorm());
    }
    out[k] = std::log(std::max(std::expm1(-0.5 * nearest) / std::expm1(-0.5 * size), least_share));
  }
  return out;
}

}  // namespace

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
    const std::vector<Matrix> terms = whiten_bank(bank, model.observables, metric);
    posterior.discrepancy =
        fit_unknown(bank, terms, model.observables.blocks.size(), metric, log_distinct(terms, signatures, metric));
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
