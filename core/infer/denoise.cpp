#include "infer/denoise.hpp"

#include <array>
#include <cmath>

namespace calx::infer {

namespace {

constexpr std::array<double, 6> strengths = {0.5, 1.5, 4, 10, 30, 100};  // of a response, in declared sd
constexpr double with_constant = 0.3;  // variance of the constant that every process may carry

Vector whiten(const Vector& z, double white, double alpha) { return (z.array() - alpha * z.mean()) / white; }

}  // namespace

Denoiser::Denoiser(const Observables& observables, const SeedScatter& scatter) {
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const Block& block = observables.blocks[b];
    Part part;
    part.first = observables.first(b), part.size = observables.size(b), part.sd = block.sd;
    const int n = part.size;
    // (w^2 I + c^2 1 1^T)^(-1/2) = (I - alpha 1 1^T / n) / w.
    const double full = std::sqrt(std::pow(scatter.white[b], 2) + n * std::pow(scatter.common[b], 2));
    part.white = scatter.white[b], part.alpha = 1 - scatter.white[b] / full;
    std::vector<Matrix> columns = {Matrix::Ones(n, 1)};
    const auto process = [&](double length) {
      columns.push_back(low_rank(with_constant * Matrix::Ones(n, n) + smooth_kernel(block, length), 1e-3));
    };
    if (n >= 3) process(0.3);
    if (n >= 17) process(0.08);
    for (Matrix& f : columns) {
      for (int k = 0; k < f.cols(); ++k) f.col(k) = whiten(f.col(k), part.white, part.alpha);
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(f.transpose() * f);
      Kernel kernel;
      kernel.powers = solver.eigenvalues().cwiseMax(1e-12);
      kernel.modes = f * solver.eigenvectors() * kernel.powers.cwiseSqrt().cwiseInverse().asDiagonal();
      part.kernels.push_back(kernel);
    }
    part.mean_power = (1 + n * with_constant) / (full * full);
    part.other_power = 1 / (part.white * part.white);
    parts_.push_back(part);
  }
}

Vector Denoiser::operator()(const Vector& response, double variance, double* log_evidence) const {
  Vector clean = Vector::Zero(response.size());
  for (const Part& part : parts_) {
    const int n = part.size;
    if (response.segment(part.first, n).isZero(0)) continue;
    const Vector y = whiten(response.segment(part.first, n).cwiseQuotient(part.sd), part.white, part.alpha);
    const bool has_white = n >= 3;
    const double models = static_cast<double>(strengths.size() * (part.kernels.size() + (has_white ? 1 : 0)));
    // Log odds against "exactly zero", and posterior mean, of each model.
    std::vector<double> odds = {0};
    std::vector<Vector> means = {Vector::Zero(n)};
    for (const Kernel& kernel : part.kernels) {
      const Vector q = kernel.modes.transpose() * y;
      for (double strength : strengths) {
        const Vector p = strength * strength / variance * kernel.powers;
        const Vector share = p.cwiseQuotient((p.array() + 1).matrix());
        odds.push_back(0.5 * share.dot(q.cwiseAbs2()) / variance - 0.5 * p.array().log1p().sum() - std::log(models));
        means.push_back(kernel.modes * share.cwiseProduct(q));
      }
    }
    for (double strength : strengths) {
      if (!has_white) break;
      const double mean = y.mean(), p0 = strength * strength * part.mean_power / variance,
                   p1 = strength * strength * part.other_power / variance;
      const double along = n * mean * mean, across = y.squaredNorm() - along;
      odds.push_back(0.5 / variance * (p0 / (1 + p0) * along + p1 / (1 + p1) * across) -
                     0.5 * (std::log1p(p0) + (n - 1) * std::log1p(p1)) - std::log(models));
      means.push_back((p1 / (1 + p1) * (y.array() - mean) + p0 / (1 + p0) * mean).matrix());
    }
    double largest = 0, sum = 0;
    for (double o : odds) largest = std::max(largest, o);
    Vector mean = Vector::Zero(n);
    for (std::size_t m = 0; m < odds.size(); ++m) {
      const double weight = std::exp(odds[m] - largest);
      sum += weight;
      mean += weight * means[m];
    }
    mean /= sum;
    if (log_evidence != nullptr)
      *log_evidence += largest + std::log(sum) - 0.5 * y.squaredNorm() / variance - 0.5 * n * std::log(variance);
    // Back from the whitened block: (I - a 1 1^T / n)^-1 = I + a / (1 - a) 1 1^T / n.
    const double back = part.alpha / (1 - part.alpha) * mean.mean();
    clean.segment(part.first, n) = part.white * part.sd.cwiseProduct((mean.array() + back).matrix());
  }
  return clean;
}

}  // namespace calx::infer
