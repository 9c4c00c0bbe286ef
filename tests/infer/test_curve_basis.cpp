#include <doctest/doctest.h>

#include "base/random.hpp"
#include "infer/curve_basis.hpp"

namespace calx {

TEST_CASE("curves that are sums of two shapes come back from two coefficients") {
  Random random(1, 2);
  Eigen::MatrixXd curves(12, 9);
  for (Eigen::Index k = 0; k < 12; ++k) {
    const double a = random.normal(), b = random.normal();
    for (Eigen::Index j = 0; j < 9; ++j) {
      const double t = static_cast<double>(j) / 8;
      curves(k, j) = 5 + a * t + b * t * t;
    }
  }
  const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(9, 0.5, 2);
  const CurveBasis basis = curve_basis(curves, scale, 0.999999);
  CHECK(basis.shapes.cols() == 2);
  CHECK(basis.rest.maxCoeff() < 1e-10);
  for (Eigen::Index k = 0; k < 12; ++k) {
    const Eigen::VectorXd curve = curves.row(k).transpose();
    CHECK((basis.curve(basis.coefficients(curve)) - curve).norm() < 1e-9);
  }
}

TEST_CASE("what components leave out is counted at each point") {
  // White scatter of sd 0.1 about one shape: the rest has its variance, less the part that the component took.
  Random random(3, 2);
  Eigen::MatrixXd curves(400, 6);
  for (Eigen::Index k = 0; k < 400; ++k) {
    const double a = 3 * random.normal();
    for (Eigen::Index j = 0; j < 6; ++j) curves(k, j) = a + 0.1 * random.normal();
  }
  const CurveBasis basis = curve_basis(curves, Eigen::VectorXd::Ones(6), 0.95);
  CHECK(basis.shapes.cols() == 1);
  // The component takes one sixth of the white variance; the variance of 400 draws is known to 7 %; three times that.
  CHECK(basis.rest.mean() == doctest::Approx(0.01 * 5 / 6).epsilon(0.1));
  CHECK(basis.rest.minCoeff() > 0.006);
}

TEST_CASE("a single point is its own component") {
  Eigen::MatrixXd curves(3, 1);
  curves << 1, 2, 6;
  const CurveBasis basis = curve_basis(curves, Eigen::VectorXd::Constant(1, 0.3));
  CHECK(basis.mean(0) == doctest::Approx(3));
  CHECK(basis.coefficients(Eigen::VectorXd::Constant(1, 7.5))(0) == doctest::Approx(4.5));
}

}  // namespace calx
