#include "infer/bank.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace calx::infer {

namespace {

constexpr std::array<double, 5> strengths = {1, 2, 4, 8, 16};  // prior sd of a discrepancy, in declared sd
// Steps, teeth and waves along time are what wear, refills, shifts and weather do, and what a slow trend is mistaken
// for: each gets about the prior of one effect of a library.
constexpr double sudden_share = 0.5;
constexpr double second_share = 0.4;  // prior share of discrepancies in two blocks

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

/// Odds of further columns where columns c are free with prior sd one.
class Beside {
 public:
  Beside(const Matrix& c, const Vector& r)
      : c_(c), r_(r), factor_(Matrix::Identity(c.cols(), c.cols()) + c.transpose() * c) {
    cr_ = factor_.matrixL().solve(c.transpose() * r);
  }
  /// Log odds of c itself.
  double base() const { return 0.5 * cr_.squaredNorm() - Matrix(factor_.matrixL()).diagonal().array().log().sum(); }
  std::array<double, strengths.size()> odds(const Matrix& columns) const {
    const Matrix cb = factor_.matrixL().solve(c_.transpose() * columns);
    return odds_of(columns.transpose() * columns - cb.transpose() * cb,
                   columns.transpose() * r_ - cb.transpose() * cr_);
  }

 private:
  const Matrix& c_;
  const Vector& r_;
  Eigen::LLT<Matrix> factor_;
  Vector cr_;
};

}  // namespace

Bank make_bank(const Observables& observables, const Vector& base) {
  Bank bank;
  std::vector<double> log_members;  // of the family of each term
  std::vector<bool> sudden;
  double sudden_families = 0, other_families = 0;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const Vector own = base.size() == 0 ? base : Vector(base.segment(observables.first(b), observables.size(b)));
    const std::vector<Term> terms = terms_of(observables, b, own);
    for (std::size_t k = 0; k < terms.size();) {
      std::size_t end = k;
      while (end < terms.size() && terms[end].family == terms[k].family &&
             terms[end].sums.rows() == terms[k].sums.rows())
        ++end;
      const std::string& family = terms[k].family;
      const bool is_sudden =
          observables.blocks[b].ordered && (family == "step" || family == "sawtooth" || family == "periodic");
      (is_sudden ? sudden_families : other_families) += 1;
      for (std::size_t m = k; m < end; ++m) {
        log_members.push_back(std::log(static_cast<double>(end - k)));
        sudden.push_back(is_sudden);
      }
      k = end;
    }
    bank.terms.insert(bank.terms.end(), terms.begin(), terms.end());
  }
  for (std::size_t k = 0; k < bank.terms.size(); ++k) {
    const double share = sudden_families == 0 ? 1 : sudden[k] ? sudden_share : 1 - sudden_share;
    bank.log_share.push_back(std::log(share / (sudden[k] ? sudden_families : other_families)) - log_members[k]);
  }
  return bank;
}

Matrix columns_of(const Term& term, const Observables& observables) {
  Matrix all = Matrix::Zero(observables.rows(), term.columns.cols());
  all.middleRows(observables.first(term.block), term.columns.rows()) = term.columns;
  if (term.sums.rows() > 0) all.middleRows(observables.first(term.sums_block), term.sums.rows()) = term.sums;
  return all;
}

Matrix whiten_term(const Term& term, const Observables& observables, const Metric& metric) {
  Matrix w = metric.whiten_rows(term.columns, observables.first(term.block));
  if (term.sums.rows() > 0) w += metric.whiten_rows(term.sums, observables.first(term.sums_block));
  return w;
}

std::vector<Matrix> whiten_bank(const Bank& bank, const Observables& observables, const Metric& metric) {
  std::vector<Matrix> out;
  for (const Term& term : bank.terms) out.push_back(whiten_term(term, observables, metric));
  return out;
}

UnknownFit fit_unknown(const Bank& bank, const std::vector<Matrix>& whitened, std::size_t blocks, const Metric& metric,
                       const std::vector<double>& log_distinct) {
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
      all.push_back(o + bank.log_share[k] - log_strengths + (log_distinct.empty() ? 0 : log_distinct[k]));
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
    const Beside beside(c, r);
    std::vector<double> second;
    for (std::size_t m = 0; m < whitened.size(); ++m) {
      if (bank.terms[m].block == block) continue;
      const auto odds = beside.odds(whitened[m]);
      for (double o : odds) second.push_back(o + bank.log_share[m] - log_strengths);
    }
    if (!second.empty()) two.push_back(beside.base() + log_sum(second) + bank.log_share[k] - log_strengths);
  }
  fit.odds = one;
  if (!two.empty()) fit.odds = log_sum({one + std::log(1 - second_share), log_sum(two) + std::log(second_share)});
  return fit;
}

}  // namespace calx::infer
