#include "infer/checks.hpp"

#include <algorithm>
#include <cmath>

#include "infer/heavy_tails.hpp"

namespace calx::infer {

FitCheck check_fit(const LinearModel& model, const Bank& bank, const Matrix& systematic, const Matrix& noise,
                   const Vector& residual, const Options& options, std::uint64_t stream) {
  const Observables& all = model.observables;
  const Matrix covariance = systematic + noise;
  const Metric metric(covariance, residual);
  const auto n = residual.size();
  // Unit directions of all terms, whitened.
  Matrix directions(n, 0);
  std::vector<std::size_t> owner;
  for (std::size_t t = 0; t < bank.terms.size(); ++t) {
    const Term& term = bank.terms[t];
    Matrix w = whiten_term(term, all, metric);
    w.colwise().normalize();
    directions.conservativeResize(n, directions.cols() + w.cols());
    directions.rightCols(w.cols()) = w;
    owner.insert(owner.end(), static_cast<std::size_t>(w.cols()), t);
  }

  Random random(options.seed, stream);
  Matrix null(n, options.nulls);
  const Matrix gauss_root = Eigen::LLT<Matrix>(systematic).matrixL();
  const Matrix noise_root = Eigen::LLT<Matrix>(noise).matrixL();
  Matrix gauss(n, options.nulls), heavy(n, options.nulls);
  for (int k = 0; k < options.nulls; ++k)
    for (int i = 0; i < n; ++i) gauss(i, k) = random.normal(), heavy(i, k) = heavy_tailed(random);
  heavy = noise_root.triangularView<Eigen::Lower>() * heavy;
  for (int k = 0; k < options.nulls; ++k) misstate_blocks(random, all, heavy.col(k));
  heavy += gauss_root.triangularView<Eigen::Lower>() * gauss;
  null = metric.whiten(heavy);

  const auto rank = [&](const Vector& values, double seen) {
    return static_cast<double>((values.array() >= seen).count() + 1) / (options.nulls + 1);
  };
  FitCheck check;
  check.total = rank(null.colwise().squaredNorm().transpose(), metric.residual().squaredNorm());
  const Matrix projections = (directions.transpose() * null).cwiseAbs();
  const Vector seen = (directions.transpose() * metric.residual()).cwiseAbs();
  check.structured = rank(projections.colwise().maxCoeff().transpose(), seen.maxCoeff());
  check.p = std::min(1.0, 2 * std::min(check.total, check.structured));

  int column = 0;
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    const int first = all.first(b), size = all.size(b);
    BlockCheck block;
    int count = 0;
    while (column + count < seen.size() && bank.terms[owner[static_cast<std::size_t>(column + count)]].block == b)
      ++count;
    Eigen::Index at = 0;
    const double largest = seen.segment(column, count).maxCoeff(&at);
    block.strongest = owner[static_cast<std::size_t>(column + at)];
    block.p = rank(projections.middleRows(column, count).colwise().maxCoeff().transpose(), largest);
    column += count;
    block.departure = residual.segment(first, size).mean();
    block.z = block.departure / std::sqrt(covariance.block(first, first, size, size).sum()) * size;
    check.blocks.push_back(block);
  }
  return check;
}

}  // namespace calx::infer
