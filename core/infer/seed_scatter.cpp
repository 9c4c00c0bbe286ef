#include "infer/seed_scatter.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace calx::infer {

namespace {

constexpr double least_gain = 3;        // nats by which a correlation has to be more probable than none
constexpr Eigen::Index least_size = 4;  // numbers that show a correlation
constexpr double least_variance = 0.05;

struct Residuals {
  Matrix squares;  // sum of z z^T about the mean of each group
  double freedom = 0;
};

Residuals residuals_of(const Vector& sd, int first, const std::vector<Matrix>& groups) {
  const Eigen::Index n = sd.size();
  Residuals out{Matrix::Zero(n, n)};
  for (const Matrix& group : groups) {
    if (group.cols() < 2) continue;
    const Matrix own = group.middleRows(first, n);
    const Matrix z = sd.cwiseInverse().asDiagonal() * (own.colwise() - own.rowwise().mean());
    out.squares += z * z.transpose();
    out.freedom += static_cast<double>(group.cols() - 1);
  }
  return out;
}

struct Parts {
  double white = 0, common = 0, correlation = 0, likelihood = 0;
};

Matrix covariance_of(const Parts& parts, int n) {
  return parts.common * parts.common * Matrix::Ones(n, n) +
         parts.white * parts.white * autocorrelation_matrix(n, parts.correlation);
}

double log_likelihood(const Residuals& residuals, const Matrix& covariance) {
  const Eigen::LLT<Matrix> factor(covariance);
  const double log_determinant = 2 * Matrix(factor.matrixL()).diagonal().array().log().sum();
  return -0.5 * factor.solve(residuals.squares).trace() - 0.5 * residuals.freedom * log_determinant;
}

/// The white part correlated along the index: most probable of a few correlations and shares of the common mode.
Parts most_probable(const Residuals& residuals) {
  const int n = static_cast<int>(residuals.squares.rows());
  Parts best;
  best.likelihood = -1e300;
  for (const double correlation : {0.3, 0.5, 0.7, 0.8, 0.9, 0.95})
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      Parts parts{std::sqrt(1 - share), std::sqrt(share), correlation, 0};
      const Eigen::LLT<Matrix> factor(covariance_of(parts, n));
      const double size = std::sqrt(factor.solve(residuals.squares).trace() / (residuals.freedom * n));
      parts.white *= size, parts.common *= size;
      parts.likelihood = log_likelihood(residuals, covariance_of(parts, n));
      if (parts.likelihood > best.likelihood) best = parts;
    }
  return best;
}

}  // namespace

Matrix SeedScatter::block(const Block& block, std::size_t number) const {
  const Parts parts{white[number], common[number], correlation[number], 0};
  return profile[number].asDiagonal() * covariance_of(parts, static_cast<int>(block.sd.size())) *
         profile[number].asDiagonal();
}

Matrix SeedScatter::covariance(const Observables& observables) const {
  Matrix c = Matrix::Zero(observables.rows(), observables.rows());
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const Vector& sd = observables.blocks[b].sd;
    const int first = observables.first(b), n = observables.size(b);
    c.block(first, first, n, n) = sd.asDiagonal() * block(observables.blocks[b], b) * sd.asDiagonal();
  }
  return c;
}

Vector shrunk_variances(const Vector& variances, double freedom) {
  const double mean = variances.mean();
  if (variances.size() < least_size || !(mean > 0)) return Vector::Ones(variances.size());
  const Vector ratio = variances / mean;
  // A variance estimated with f degrees of freedom has a relative variance of 2 / f.
  const double spread = (ratio.array() - 1).square().sum() / static_cast<double>(ratio.size() - 1),
               chance = 2 / freedom, kept = std::max(0.0, spread - chance) / std::max(spread, 1e-300);
  const Vector drawn = (1 + kept * (ratio.array() - 1)).max(least_variance);
  return drawn / drawn.mean();
}

SeedScatter estimate_scatter(const Observables& observables, const std::vector<Matrix>& groups) {
  SeedScatter scatter;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const int first = observables.first(b), n = observables.size(b);
    const Vector& sd = observables.blocks[b].sd;
    const Residuals plain = residuals_of(sd, first, groups);
    if (plain.freedom < 1) throw Error(Fault::settings, "seed scatter needs two runs of the same parameters at least");
    const Vector profile = shrunk_variances(plain.squares.diagonal() / plain.freedom, plain.freedom).cwiseSqrt();
    const Residuals residuals = residuals_of(sd.cwiseProduct(profile), first, groups);
    // Expected: all = white + common, means = white / n + common (variances).
    const double all = residuals.squares.trace() / (n * residuals.freedom),
                 means = residuals.squares.sum() / (static_cast<double>(n) * n * residuals.freedom);
    double white = all, common = 0;
    if (n > 1) {
      white = std::clamp((all - means) * n / (n - 1.0), 0.0, all);
      common = all - white;
    }
    // Runs without any scatter would make the covariance of signatures singular.
    Parts parts{std::max(std::sqrt(white), 1e-3), std::sqrt(common), 0, 0};
    if (n >= least_size && all > 0) {
      const Parts other = most_probable(residuals);
      if (other.likelihood > log_likelihood(residuals, covariance_of(parts, n)) + least_gain) parts = other;
    }
    scatter.white.push_back(std::max(parts.white, 1e-3));
    scatter.common.push_back(parts.common);
    scatter.correlation.push_back(parts.correlation);
    scatter.profile.push_back(profile);
  }
  return scatter;
}

}  // namespace calx::infer
