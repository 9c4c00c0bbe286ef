#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/random.hpp"
#include "infer/sampler.hpp"

namespace calx {
namespace {

Eigen::MatrixXd around(const Eigen::VectorXd& centre, Eigen::Index walkers, double size, std::uint64_t seed) {
  Random random(seed, 9);
  Eigen::MatrixXd out(walkers, centre.size());
  for (Eigen::Index k = 0; k < walkers; ++k)
    for (Eigen::Index j = 0; j < centre.size(); ++j) out(k, j) = centre(j) + size * random.normal();
  return out;
}

SamplerSettings long_run() {
  SamplerSettings s;
  s.steps = 6000;
  s.first = 1000;
  s.keep_every = 5;
  return s;
}

}  // namespace

TEST_CASE("draws from a normal density have its mean and covariance, however stretched and tilted it is") {
  Eigen::Matrix3d root;
  root << 1, 0, 0, 0.9, 0.2, 0, -50, 10, 30;  // scales 1, 1 and 60
  const Eigen::Matrix3d covariance = root * root.transpose(), inverse = covariance.inverse();
  const Eigen::Vector3d mean(3, -2, 100);
  const Samples s = draw([&](const Eigen::VectorXd& x) { return -0.5 * (x - mean).dot(inverse * (x - mean)); },
                         around(Eigen::Vector3d(0, 0, 0), 20, 1, 4), long_run());
  MESSAGE("worth ", s.effective, " independent draws of ", s.x.rows(), ", acceptance ", s.acceptance);
  CHECK(s.effective > 1000);
  CHECK(s.acceptance > 0.3);
  const Eigen::RowVectorXd found = s.x.colwise().mean();
  const Eigen::MatrixXd centred = s.x.rowwise() - found;
  const Eigen::Matrix3d spread = centred.transpose() * centred / static_cast<double>(centred.rows() - 1);
  for (Eigen::Index k = 0; k < 3; ++k) {
    // Four standard errors of a mean and of a variance of so many independent draws.
    const double sd = std::sqrt(covariance(k, k)), error = 4 / std::sqrt(s.effective);
    CHECK(std::fabs(found(k) - mean(k)) < error * sd);
    CHECK(std::fabs(spread(k, k) / covariance(k, k) - 1) < std::sqrt(2.0) * error);
    for (Eigen::Index j = 0; j < k; ++j) {
      const double size = sd * std::sqrt(covariance(j, j));
      CHECK(std::fabs(spread(k, j) - covariance(k, j)) < std::sqrt(2.0) * error * size);
    }
  }
}

TEST_CASE("a density that ends is never left, and its quantiles are right") {
  // A half-normal: the median is 0.6745.
  const Samples s = draw(
      [](const Eigen::VectorXd& x) {
        if (x(0) < 0 || x(1) < 0 || x(1) > 1) return -std::numeric_limits<double>::infinity();
        return -0.5 * x(0) * x(0);
      },
      around(Eigen::Vector2d(1, 0.5), 12, 0.05, 2), long_run());
  CHECK(s.x.minCoeff() >= 0);
  CHECK(s.x.col(1).maxCoeff() <= 1);
  std::vector<double> x(s.x.col(0).data(), s.x.col(0).data() + s.x.rows());
  std::sort(x.begin(), x.end());
  // The median has the error 1/2 / density / sqrt(n), the density there being 0.636; four times that.
  CHECK(std::fabs(x[x.size() / 2] - 0.67449) < 4 * 0.5 / 0.636 / std::sqrt(s.effective));
  CHECK(std::fabs(s.x.col(1).mean() - 0.5) < 4 * 0.2887 / std::sqrt(s.effective));
}

TEST_CASE("the same seed gives the same draws; too few walkers are refused") {
  const auto density = [](const Eigen::VectorXd& x) { return -x.squaredNorm(); };
  SamplerSettings s;
  s.steps = 50;
  s.first = 10;
  const Eigen::MatrixXd start = around(Eigen::Vector2d(0, 0), 8, 1, 3);
  CHECK(draw(density, start, s).x == draw(density, start, s).x);
  s.seed = 2;
  CHECK(draw(density, start, s).x != draw(density, start, SamplerSettings()).x);
  CHECK_THROWS_AS(draw(density, start.topRows(4), s), std::invalid_argument);
  CHECK_THROWS_AS(draw(density, start.topRows(7), s), std::invalid_argument);
}

}  // namespace calx
