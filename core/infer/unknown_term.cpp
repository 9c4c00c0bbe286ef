#include "infer/unknown_term.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/random.hpp"

namespace calx::infer {

namespace {

constexpr std::array<double, 3> strengths = {1, 3, 9};  // prior sd of a coefficient, in declared sd
constexpr int most_terms = 3, knock_outs = 12;
constexpr double chosen_strength = 5;

struct Choice {
  std::size_t term = 0;
  double gain = -1e300;
};

Choice best_term(const std::vector<std::size_t>& candidates, const Bank& bank, const Observables& observables,
                 const Matrix& covariance, const Vector& residual, const std::vector<std::size_t>& taken) {
  const Metric metric(covariance, residual);
  Choice best;
  for (std::size_t t : candidates) {
    if (std::find(taken.begin(), taken.end(), t) != taken.end()) continue;
    const Matrix columns = whiten_term(bank.terms[t], observables, metric);
    std::vector<double> odds;
    for (double s : strengths) odds.push_back(low_rank_odds(metric.residual(), s * columns));
    const double gain = log_sum(odds) - std::log(strengths.size()) - std::log(static_cast<double>(candidates.size()));
    if (gain > best.gain) best = {t, gain};
  }
  return best;
}

std::string in_words(const Block& block, const Term& term, double size, double sd) {
  char text[300];
  const auto say = [&](const char* format, auto... numbers) {
    std::snprintf(text, sizeof text, format, block.name.c_str(), numbers...);
    return std::string(text);
  };
  if (term.family == "step") return say("%s: a step of %+.3g +/- %.2g at %.3g", size, sd, term.place);
  if (term.family == "hinge") return say("%s: a bend from %.3g on, reaching %+.3g +/- %.2g", term.place, size, sd);
  if (term.family == "bump") return say("%s: a local departure of %+.3g +/- %.2g near %.3g", size, sd, term.place);
  if (term.family == "drift") return say("%s: a steady drift, %+.3g +/- %.2g in all", size, sd);
  if (term.family == "decay")
    return say("%s: a departure of %+.3g +/- %.2g that fades over %.3g", size, sd, term.place);
  if (term.family == "periodic") return say("%s: a wave of %.3g +/- %.2g with period %.3g", size, sd, term.place);
  if (term.family == "shift") return say("%s: displaced by %+.3g +/- %.2g along its index", size, sd);
  if (term.family == "sawtooth") return say("%s: a sawtooth of %+.3g +/- %.2g with period %.3g", size, sd, term.place);
  return say("%s: a constant shift of %+.3g +/- %.2g", size, sd);
}

}  // namespace

std::vector<UnknownTerm> find_terms(const LinearModel& model, const Bank& bank, const Diagnosis& diagnosis,
                                    const Options& options) {
  const Observables& all = model.observables;
  const UnknownFit& unknown = diagnosis.posterior.discrepancy;
  if (unknown.block_share.empty()) return {};
  const auto block = static_cast<std::size_t>(std::max_element(unknown.block_share.begin(), unknown.block_share.end()) -
                                              unknown.block_share.begin());
  std::vector<std::size_t> candidates;
  for (std::size_t t = 0; t < bank.terms.size(); ++t)
    if (bank.terms[t].block == block && bank.terms[t].family != "smooth" && bank.terms[t].family != "rough")
      candidates.push_back(t);
  const View& view = options.stacking ? diagnosis.budget.both : diagnosis.budget.fit;
  const auto [residual, plain] = pose(model, diagnosis.budget.systematic, view, options);
  const int first = all.first(block), n = all.size(block);

  Matrix covariance = plain;
  std::vector<std::size_t> taken;
  std::vector<UnknownTerm> out;
  while (out.size() < most_terms) {
    const Choice choice = best_term(candidates, bank, all, covariance, residual, taken);
    if (choice.gain < least_term_odds) break;
    UnknownTerm found;
    found.term = choice.term, found.gain = choice.gain;
    taken.push_back(choice.term), out.push_back(found);
    const Matrix c = columns_of(bank.terms[choice.term], all);
    covariance += chosen_strength * chosen_strength * c * c.transpose();
  }
  if (out.empty()) return out;

  int same = 0;
  Random random(options.seed, 3);
  for (int k = 0; k < knock_outs; ++k) {
    Matrix knocked = plain;
    for (int m = 0; m < std::max(1, n / 5); ++m) {
      const int row = first + static_cast<int>(random.bits() % static_cast<std::uint64_t>(n));
      knocked(row, row) += 1e6 * std::pow(all.blocks[block].sd[row - first], 2);
    }
    const Choice choice = best_term(candidates, bank, all, knocked, residual, {});
    same += bank.terms[choice.term].family == bank.terms[out[0].term].family ? 1 : 0;
  }
  out[0].stability = static_cast<double>(same) / knock_outs;

  // All coefficients together, given the error budget.
  Matrix columns(residual.size(), 0);
  for (const UnknownTerm& t : out) {
    const Matrix c = columns_of(bank.terms[t.term], all);
    columns.conservativeResize(Eigen::NoChange, columns.cols() + c.cols());
    columns.rightCols(c.cols()) = c;
  }
  const Metric metric(plain, residual);
  const Matrix w = metric.whiten(columns);
  const Matrix v =
      (w.transpose() * w + Matrix::Identity(w.cols(), w.cols()) / (chosen_strength * chosen_strength)).inverse();
  const Vector a = v * (w.transpose() * metric.residual());
  Eigen::Index column = 0;
  const double sd = all.blocks[block].sd.mean();
  for (UnknownTerm& t : out) {
    const auto count = bank.terms[t.term].columns.cols();
    t.coefficients = a.segment(column, count);
    const double unit = bank.terms[t.term].family == "shift" ? bank.terms[t.term].place : sd;
    t.size = unit * (count == 1 ? t.coefficients[0] : t.coefficients.norm());
    t.size_sd = unit * std::sqrt(v(column, column));
    t.words = in_words(all.blocks[block], bank.terms[t.term], t.size, t.size_sd);
    column += count;
  }
  return out;
}

}  // namespace calx::infer
