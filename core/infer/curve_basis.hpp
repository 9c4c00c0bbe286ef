// curve_basis.hpp: a few shapes that curves of runs are sums of, so that a curve of 30 points needs 1 to 5 emulators.
#pragma once
#include <Eigen/Dense>

namespace calx {

/// Principal components of curves (Higdon, Gattiker, Williams and Rightley 2008, J. Am. Stat. Assoc. 103, section 2).
struct CurveBasis {
  Eigen::VectorXd mean;    // of the curves
  Eigen::MatrixXd shapes;  // one column a component, one row a point of the curve
  Eigen::VectorXd rest;    // variance at each point that the components leave out

  Eigen::VectorXd coefficients(const Eigen::VectorXd& curve) const;
  Eigen::VectorXd curve(const Eigen::VectorXd& coefficients) const { return mean + shapes * coefficients; }
};

/// curves: one a row, two or more. scale: a size for each point, above 0, in which deviations count; components are
/// kept until they hold share of the variance so counted, at most most. One point gives one component of 1.
CurveBasis curve_basis(const Eigen::MatrixXd& curves, const Eigen::VectorXd& scale, double share = 0.99,
                       Eigen::Index most = 5);

}  // namespace calx
