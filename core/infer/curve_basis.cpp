#include "infer/curve_basis.hpp"

#include <Eigen/SVD>

namespace calx {

// Shapes are orthogonal in scaled points only, so that a curve is projected by least squares there; the inverse is that
// of the few components.
Eigen::VectorXd CurveBasis::coefficients(const Eigen::VectorXd& curve) const {
  return (shapes.transpose() * shapes).ldlt().solve(shapes.transpose() * (curve - mean));
}

CurveBasis curve_basis(const Eigen::MatrixXd& curves, const Eigen::VectorXd& scale, double share, Eigen::Index most) {
  CurveBasis out;
  const Eigen::Index n = curves.rows(), m = curves.cols();
  out.mean = curves.colwise().mean().transpose();
  out.rest = Eigen::VectorXd::Zero(m);
  if (m == 1) {
    out.shapes = Eigen::MatrixXd::Ones(1, 1);
    return out;
  }
  const Eigen::MatrixXd scaled = (curves.rowwise() - out.mean.transpose()) * scale.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd power = svd.singularValues().array().square();
  const double all = power.sum();
  Eigen::Index kept = 1;
  for (double sum = power(0); kept < std::min({most, n - 1, m}) && sum < share * all; ++kept) sum += power(kept);
  out.shapes = scale.asDiagonal() * svd.matrixV().leftCols(kept);
  const Eigen::MatrixXd left =
      scaled - scaled * svd.matrixV().leftCols(kept) * svd.matrixV().leftCols(kept).transpose();
  out.rest = left.array().square().colwise().sum().transpose() / static_cast<double>(std::max<Eigen::Index>(n - 1, 1));
  out.rest = out.rest.cwiseProduct(scale.cwiseProduct(scale));
  return out;
}

}  // namespace calx
