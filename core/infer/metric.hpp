// metric.hpp: residuals in the metric of the error budget, with everything that recalibration absorbs marginalised.
// Evidences are log odds against "the model is right": constants cancel.
#pragma once
#include "infer/observables.hpp"

namespace calx::infer {

/// Residual r ~ N(0, S), whitened by the inverse Cholesky factor of S.
class Metric {
 public:
  /// covariance: positive definite, else Error with Fault::numerics.
  Metric(const Matrix& covariance, const Vector& residual);

  const Matrix& inverse() const { return inverse_; }
  const Vector& residual() const { return residual_; }  // whitened
  Matrix whiten(const Matrix& columns) const { return inverse_.triangularView<Eigen::Lower>() * columns; }
  /// Of columns that are zero outside rows first .. first + columns.rows() - 1.
  Matrix whiten_rows(const Matrix& columns, int first) const;
  double log_determinant() const { return log_determinant_; }
  /// ln N(r; 0, S).
  double log_density() const;

 private:
  Matrix inverse_;
  Vector residual_;
  double log_determinant_ = 0;
};

/// Log odds of r ~ N(0, I + C C^T) against r ~ N(0, I). r and the columns C are whitened.
double low_rank_odds(const Vector& r, const Matrix& columns);

double log_sum(const std::vector<double>& terms);

}  // namespace calx::infer
