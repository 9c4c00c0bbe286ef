#include "infer/bank.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace calx::infer {

namespace {

constexpr std::array<double, 5> strengths = {1, 2, 4, 8, 16};  // prior sd of a discrepancy, in declared sd
constexpr double second_share = 0.4;                           // prior share of discrepancies in two blocks

/// Log odds of N(0, I + t^2 B B^T) for each strength t, from B^T B and B^T r.
std::array<double, strengths.size()> odds_of(const Matrix& gram, const Vector& pull) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(gram);
  const Vector q = solver.eigenvectors().transpose() * pull;
  std::array<double, strengths.size()> odds;
  for (std::size_t s = 0; s < strengths.size(); ++s) {
    const double t2 = strengths[s] * strengths[s];
    odds[s] = 0;
    for (int k = 0; k < q.size(); ++k) {
      const double p = t2 * std::max(solver.eigenvalues()[k], 0.0);
      odds[s] += 0.5 * t2 * q[k] * q[k] / (1 + p) - 0.5 * std::log1p(p);
    }
  }
  return odds;
}

}  // namespace

Bank make_bank(const Observables& observables) {
  Bank bank;
  std::size_t families = 0;
  std::vector<double> members;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const std::vector<Term> terms = terms_of(observables, b);
    for (std::size_t k = 0; k < terms.size();) {
      std::size_t end = k;
      while (end < terms.size() && terms[end].family == terms[k].family) ++end;
      ++families;
      for (std::size_t m = k; m < end; ++m) members.push_back(static_cast<double>(end - k));
      k = end;
    }
    bank.terms.insert(bank.terms.end(), terms.begin(), terms.end());
  }
  for (double m : members) bank.log_share.push_back(-std::log(m * static_cast<double>(families)));
  return bank;
}

std::vector<Matrix> whiten_bank(const Bank& bank, const Observables& observables, const Metric& metric) {
  std::vector<Matrix> out;
  for (const Term& term : bank.terms) out.push_back(metric.whiten_rows(term.columns, observables.first(term.block)));
  return out;
}

UnknownFit fit_unknown(const Bank& bank, const std::vector<Matrix>& whitened, std::size_t blocks,
                       const Metric& metric) {
  const Vector& r = metric.residual();
  const double log_strengths = std::log(static_cast<double>(strengths.size()));
  UnknownFit fit;
  std::vector<double> best(whitened.size()), all;
  std::vector<std::size_t> best_strength(whitened.size());
  std::vector<std::vector<double>> per_block(blocks);
  for (std::size_t k = 0; k < whitened.size(); ++k) {
    const auto odds = odds_of(whitened[k].transpose() * whitened[k], whitened[k].transpose() * r);
    best_strength[k] = static_cast<std::size_t>(std::max_element(odds.begin(), odds.end()) - odds.begin());
    best[k] = odds[best_strength[k]] + bank.log_share[k];
    for (double o : odds) {
      all.push_back(o + bank.log_share[k] - log_strengths);
      per_block[bank.terms[k].block].push_back(all.back());
    }
  }
  const double one = log_sum(all);
  for (const auto& odds : per_block) fit.block_share.push_back(std::exp(log_sum(odds) - one));
  fit.term = static_cast<std::size_t>(std::max_element(best.begin(), best.end()) - best.begin());
  fit.strength = strengths[best_strength[fit.term]];

  // A second discrepancy in another block, given the best first ones of three blocks.
  std::vector<std::size_t> order(whitened.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return best[a] > best[b]; });
  std::set<std::size_t> firsts;
  std::vector<double> two;
  for (std::size_t k : order) {
    const std::size_t block = bank.terms[k].block;
    if (firsts.size() == 3) break;
    if (!firsts.insert(block).second) continue;
    const double t = strengths[best_strength[k]];
    const Matrix c = t * whitened[k];
    const Eigen::LLT<Matrix> factor(Matrix::Identity(c.cols(), c.cols()) + c.transpose() * c);
    const Vector cr = factor.matrixL().solve(c.transpose() * r);
    const double base = 0.5 * cr.squaredNorm() - Matrix(factor.matrixL()).diagonal().array().log().sum();
    std::vector<double> second;
    for (std::size_t m = 0; m < whitened.size(); ++m) {
      if (bank.terms[m].block == block) continue;
      const Matrix cb = factor.matrixL().solve(c.transpose() * whitened[m]);
      const auto odds = odds_of(whitened[m].transpose() * whitened[m] - cb.transpose() * cb,
                                whitened[m].transpose() * r - cb.transpose() * cr);
      for (double o : odds) second.push_back(o + bank.log_share[m] - log_strengths);
    }
    if (!second.empty()) two.push_back(base + log_sum(second) + bank.log_share[k] - log_strengths);
  }
  fit.odds = one;
  if (!two.empty()) fit.odds = log_sum({one + std::log(1 - second_share), log_sum(two) + std::log(second_share)});
  return fit;
}

}  // namespace calx::infer
