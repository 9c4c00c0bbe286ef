#include "infer/metric.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace calx::infer {

Metric::Metric(const Matrix& covariance, const Vector& residual) {
  const Eigen::LLT<Matrix> factor(covariance);
  if (factor.info() != Eigen::Success)
    throw Error(Fault::numerics, "the covariance of the residuals is not positive definite");
  inverse_ = Matrix::Identity(covariance.rows(), covariance.cols());
  factor.matrixL().solveInPlace(inverse_);
  residual_ = inverse_.triangularView<Eigen::Lower>() * residual;
  log_determinant_ = -2 * inverse_.diagonal().array().log().sum();
}

Matrix Metric::whiten_rows(const Matrix& columns, int first) const {
  Matrix out = Matrix::Zero(inverse_.rows(), columns.cols());
  out.bottomRows(inverse_.rows() - first).noalias() =
      inverse_.block(first, first, inverse_.rows() - first, columns.rows()) * columns;
  return out;
}

double Metric::log_density() const {
  const double n = static_cast<double>(residual_.size());
  return -0.5 * residual_.squaredNorm() - 0.5 * log_determinant_ - 0.5 * n * std::log(2 * 3.14159265358979323846);
}

double low_rank_odds(const Vector& r, const Matrix& columns) {
  if (columns.cols() == 0) return 0;
  const Eigen::LLT<Matrix> factor(Matrix::Identity(columns.cols(), columns.cols()) + columns.transpose() * columns);
  const Vector b = factor.matrixL().solve(columns.transpose() * r);
  return 0.5 * b.squaredNorm() - Matrix(factor.matrixL()).diagonal().array().log().sum();
}

double log_sum(const std::vector<double>& terms) {
  const double largest = *std::max_element(terms.begin(), terms.end());
  double sum = 0;
  for (double t : terms) sum += std::exp(t - largest);
  return largest + std::log(sum);
}

}  // namespace calx::infer
