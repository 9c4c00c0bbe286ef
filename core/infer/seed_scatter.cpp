#include "infer/seed_scatter.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace calx::infer {

Matrix SeedScatter::covariance(const Observables& observables) const {
  Matrix c = Matrix::Zero(observables.rows(), observables.rows());
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const Vector& sd = observables.blocks[b].sd;
    const int first = observables.first(b), n = observables.size(b);
    c.block(first, first, n, n) = common[b] * common[b] * sd * sd.transpose();
    c.block(first, first, n, n).diagonal() += white[b] * white[b] * sd.cwiseAbs2();
  }
  return c;
}

SeedScatter estimate_scatter(const Observables& observables, const std::vector<Matrix>& groups) {
  SeedScatter scatter;
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const int first = observables.first(b), n = observables.size(b);
    double freedom = 0, all = 0, means = 0;  // sums of squares of the residuals and of their block means
    for (const Matrix& group : groups) {
      if (group.cols() < 2) continue;
      freedom += static_cast<double>(group.cols() - 1);
      const Vector mean = group.rowwise().mean();
      for (int run = 0; run < group.cols(); ++run) {
        const Vector z =
            (group.col(run).segment(first, n) - mean.segment(first, n)).cwiseQuotient(observables.blocks[b].sd);
        all += z.squaredNorm() / n;
        means += z.mean() * z.mean();
      }
    }
    if (freedom < 1) throw Error(Fault::settings, "seed scatter needs two runs of the same parameters at least");
    all /= freedom, means /= freedom;
    // Expected: all = white + common, means = white / n + common (variances).
    double white = all, common = 0;
    if (n > 1) {
      white = std::clamp((all - means) * n / (n - 1.0), 0.0, all);
      common = all - white;
    }
    // Runs without any scatter would make the covariance of signatures singular.
    scatter.white.push_back(std::max(std::sqrt(white), 1e-3));
    scatter.common.push_back(std::sqrt(common));
  }
  return scatter;
}

}  // namespace calx::infer
