#include "infer/screen.hpp"

#include <algorithm>
#include <cmath>

namespace calx::infer {

namespace {

constexpr double inflated = 30;  // sd of a screened number, in declared sd
constexpr int rounds = 3;        // a large event can hide a smaller one

}  // namespace

std::vector<Event> screen(const LinearModel& model, const Bank& bank, const Matrix& systematic, View& view,
                          const Options& options) {
  const Observables& all = model.observables;
  Matrix free = systematic + model.sensitivities * model.sensitivities.transpose();
  for (const Term& term : bank.terms) {
    if (term.sums.rows() > 0 || (term.family != "constant" && term.family != "smooth" && term.family != "rough"))
      continue;
    const int first = all.first(term.block), n = all.size(term.block);
    free.block(first, first, n, n) += 64 * term.columns * term.columns.transpose();
  }
  for (std::size_t e = 0; e < model.effects.size(); ++e)
    free += std::pow(4 * model.effects[e].scale, 2) * model.signatures[e] * model.signatures[e].transpose();
  const Vector r = view.y - model.base + model.sensitivities * model.u, sd = all.sd();
  std::vector<bool> flagged(static_cast<std::size_t>(r.size()), false);
  std::vector<Event> events;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::LLT<Matrix> factor(free + view.noise);
    Matrix root = Matrix::Identity(r.size(), r.size());
    factor.matrixL().solveInPlace(root);
    const Vector z = factor.solve(r).cwiseQuotient(root.colwise().norm().transpose());
    double largest = 0;
    for (int k = 0; k < z.size(); ++k)
      if (!flagged[static_cast<std::size_t>(k)]) largest = std::max(largest, std::abs(z[k]));
    if (largest <= options.screen_above) break;
    for (int k = 0; k < z.size(); ++k) {
      if (flagged[static_cast<std::size_t>(k)] || std::abs(z[k]) < std::max(options.screen_above, 0.8 * largest))
        continue;
      flagged[static_cast<std::size_t>(k)] = true;
      view.noise(k, k) += std::pow(inflated * sd[k], 2);
      events.push_back({k, z[k]});
    }
  }
  return events;
}

}  // namespace calx::infer
