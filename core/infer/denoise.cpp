#include "infer/denoise.hpp"

#include <array>
#include <cmath>

namespace calx::infer {

namespace {

constexpr std::array<double, 6> strengths = {0.5, 1.5, 4, 10, 30, 100};  // of a response, in declared sd
constexpr double with_constant = 0.3;  // variance of the constant that every process may carry

}  // namespace

Denoiser::Denoiser(const Observables& observables, const SeedScatter& scatter) {
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const Block& block = observables.blocks[b];
    Part part;
    part.first = observables.first(b), part.size = observables.size(b), part.sd = block.sd;
    const int n = part.size;
    const Eigen::SelfAdjointEigenSolver<Matrix> scattered(scatter.block(block, b));
    part.whitening = scattered.operatorInverseSqrt(), part.back = scattered.operatorSqrt();
    std::vector<Matrix> columns = {Matrix::Ones(n, 1)};
    const auto process = [&](double length) {
      columns.push_back(low_rank(with_constant * Matrix::Ones(n, n) + smooth_kernel(block, length), 1e-3));
    };
    if (n >= 3) process(0.3);
    if (n >= 17) process(0.08);
    if (n >= 3)
      columns.push_back(Eigen::LLT<Matrix>(Matrix::Identity(n, n) + with_constant * Matrix::Ones(n, n)).matrixL());
    for (Matrix& f : columns) {
      f = part.whitening * f;
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(f.transpose() * f);
      Kernel kernel;
      kernel.powers = solver.eigenvalues().cwiseMax(1e-12);
      kernel.modes = f * solver.eigenvectors() * kernel.powers.cwiseSqrt().cwiseInverse().asDiagonal();
      part.kernels.push_back(kernel);
    }
    parts_.push_back(part);
  }
}

Vector Denoiser::operator()(const Vector& response, double variance, double* log_evidence) const {
  Vector clean = Vector::Zero(response.size());
  for (const Part& part : parts_) {
    const int n = part.size;
    if (response.segment(part.first, n).isZero(0)) continue;
    const Vector y = part.whitening * response.segment(part.first, n).cwiseQuotient(part.sd);
    const double models = static_cast<double>(strengths.size() * part.kernels.size());
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
    clean.segment(part.first, n) = part.sd.cwiseProduct(part.back * mean);
  }
  return clean;
}

}  // namespace calx::infer
