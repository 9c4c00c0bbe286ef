#include <doctest/doctest.h>

#include "base/error.hpp"
#include "infer/metric.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

/// ln N(r; 0, C) by an LU factor, another way than the code under test.
double log_density(const Vector& r, const Matrix& c) {
  return -0.5 * r.dot(c.fullPivLu().solve(r)) - 0.5 * std::log(c.fullPivLu().determinant()) -
         0.5 * static_cast<double>(r.size()) * std::log(2 * 3.14159265358979323846);
}

}  // namespace

TEST_CASE("log odds of a low-rank addition are those of the dense densities") {
  calx::Random random(3, 1);
  Matrix root(6, 6), columns(6, 2);
  for (double& x : root.reshaped()) x = random.normal();
  for (double& x : columns.reshaped()) x = random.normal();
  const Matrix s = root * root.transpose() + Matrix::Identity(6, 6);
  const Vector r = normal_vector(random, 6);
  const Metric metric(s, r);
  CHECK(metric.log_density() == doctest::Approx(log_density(r, s)).epsilon(1e-10));
  CHECK(low_rank_odds(metric.residual(), metric.whiten(columns)) ==
        doctest::Approx(log_density(r, s + columns * columns.transpose()) - log_density(r, s)).epsilon(1e-10));
  CHECK((metric.whiten_rows(columns.middleRows(2, 3), 2) -
         metric.whiten((Matrix(6, 2) << Matrix::Zero(2, 2), columns.middleRows(2, 3), Matrix::Zero(1, 2)).finished()))
            .norm() < 1e-12);
}

TEST_CASE("a covariance that is none is refused") {
  CHECK_THROWS_WITH_AS(Metric(-Matrix::Identity(2, 2), Vector::Zero(2)),
                       "the covariance of the residuals is not positive definite", calx::Error);
}
