#include "infer/design.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.hpp"

namespace calx {
namespace {

/// (r^2)^(-p/2) of two rows; phi_p is its sum to the power 1/p, which grows with it.
double closeness(const Eigen::MatrixXd& x, Eigen::Index a, Eigen::Index b) {
  constexpr double kHalfP = 7.5;
  return std::pow(std::max((x.row(a) - x.row(b)).squaredNorm(), 1e-12), -kHalfP);
}

double closeness_of_row(const Eigen::MatrixXd& x, Eigen::Index row, Eigen::Index leave_out) {
  double sum = 0;
  for (Eigen::Index k = 0; k < x.rows(); ++k)
    if (k != row && k != leave_out) sum += closeness(x, row, k);
  return sum;
}

std::size_t below(Random& random, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

}  // namespace

Eigen::MatrixXd random_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  Random random(seed, 0x4C4853);
  const auto n = static_cast<Eigen::Index>(count), d = static_cast<Eigen::Index>(dimensions);
  Eigen::MatrixXd out(n, d);
  std::vector<std::size_t> order(count);
  for (Eigen::Index k = 0; k < d; ++k) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(random, i)]);
    for (Eigen::Index i = 0; i < n; ++i)
      out(i, k) = (static_cast<double>(order[static_cast<std::size_t>(i)]) + random.uniform()) / static_cast<double>(n);
  }
  return out;
}

Eigen::MatrixXd latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  Eigen::MatrixXd x = random_hypercube(count, dimensions, seed);
  if (count < 3) return x;
  // A swap is kept when it lowers the sum of the two rows it moves; some 30 tries a row change nothing more.
  Random random(seed, 0x535741);
  const std::size_t tries = 30 * count * dimensions;
  for (std::size_t t = 0; t < tries; ++t) {
    const auto a = static_cast<Eigen::Index>(below(random, count)), b = static_cast<Eigen::Index>(below(random, count)),
               k = static_cast<Eigen::Index>(below(random, dimensions));
    if (a == b) continue;
    const double before = closeness_of_row(x, a, b) + closeness_of_row(x, b, a);
    std::swap(x(a, k), x(b, k));
    if (closeness_of_row(x, a, b) + closeness_of_row(x, b, a) > before) std::swap(x(a, k), x(b, k));
  }
  return x;
}

std::vector<std::size_t> spread_out(const Eigen::MatrixXd& candidates, const Eigen::MatrixXd& taken, std::size_t count,
                                    const Eigen::VectorXd& scale) {
  const Eigen::Index n = candidates.rows();
  const Eigen::MatrixXd x = candidates * scale.cwiseInverse().asDiagonal();
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::max());
  const auto add = [&](const Eigen::RowVectorXd& row) {
    for (Eigen::Index k = 0; k < n; ++k) distance(k) = std::min(distance(k), (x.row(k) - row).squaredNorm());
  };
  for (Eigen::Index k = 0; k < taken.rows(); ++k) add(taken.row(k) * scale.cwiseInverse().asDiagonal());
  std::vector<std::size_t> out;
  while (out.size() < std::min(count, static_cast<std::size_t>(n))) {
    Eigen::Index best = 0;
    distance.maxCoeff(&best);
    out.push_back(static_cast<std::size_t>(best));
    add(x.row(best));
    distance(best) = -1;
  }
  return out;
}

}  // namespace calx
