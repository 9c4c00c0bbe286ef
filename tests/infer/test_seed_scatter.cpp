#include <doctest/doctest.h>

#include <cmath>

#include "base/error.hpp"
#include "infer/seed_scatter.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

TEST_CASE("white and common scatter are told apart, whatever the means of the groups") {
  const Observables all = small_observables();
  calx::Random random(2, 1);
  std::vector<Matrix> groups;
  for (int g = 0; g < 40; ++g) {
    Matrix group(31, 10);
    for (int run = 0; run < 10; ++run) {
      const double common = 0.6 * random.normal();
      for (int k = 0; k < 30; ++k) group(k, run) = 100 * g + 0.5 * (0.8 * random.normal() + common);
      group(30, run) = 2 * 1.1 * random.normal();
    }
    groups.push_back(group);
  }
  const SeedScatter scatter = estimate_scatter(all, groups);
  // Three relative sd of an estimated sd, 1 / sqrt(2 n): n = 29 * 360 degrees of freedom for the white part of thirty
  // numbers, 360 for a single number; the variance of a block's mean is 0.6^2 + 0.8^2 / 30, known to sqrt(2 / 360).
  const double of_mean = 0.36 + 0.64 / 30;
  CHECK(scatter.white[0] == doctest::Approx(0.8).epsilon(3 / std::sqrt(2 * 29 * 360.0)));
  CHECK(scatter.common[0] == doctest::Approx(0.6).epsilon(3 * std::sqrt(2 / 360.0) * of_mean / 0.36 / 2));
  CHECK(scatter.white[1] == doctest::Approx(1.1).epsilon(3 / std::sqrt(2 * 360.0)));
  CHECK(scatter.common[1] == 0);
  CHECK(scatter.covariance(all)(30, 30) == doctest::Approx(4 * scatter.white[1] * scatter.white[1]));
}

TEST_CASE("single runs say nothing of scatter") {
  CHECK_THROWS_WITH_AS(estimate_scatter(small_observables(), {Matrix::Zero(31, 1)}),
                       "seed scatter needs two runs of the same parameters at least", calx::Error);
}

TEST_CASE("scatter that adds up along the index and grows with it is seen as that") {
  const Observables all = small_observables();
  calx::Random random(2, 3);
  std::vector<Matrix> groups;
  for (int g = 0; g < 30; ++g) {
    Matrix group = Matrix::Zero(31, 5);
    for (int run = 0; run < 5; ++run) {
      double z = random.normal();
      for (int k = 0; k < 30; ++k) {
        z = 0.9 * z + std::sqrt(1 - 0.81) * random.normal();
        group(k, run) = 0.5 * (k < 15 ? 0.5 : 1.5) * z;
      }
      group(30, run) = 2 * random.normal();
    }
    groups.push_back(group);
  }
  const SeedScatter scatter = estimate_scatter(all, groups);
  // The nearest of the correlations that are tried; 120 degrees of freedom give each variance to 13 %.
  CHECK(scatter.correlation[0] == 0.9);
  const Matrix c = scatter.covariance(all);
  CHECK(c(5, 5) == doctest::Approx(0.0625).epsilon(0.3));
  CHECK(c(25, 25) == doctest::Approx(0.5625).epsilon(0.3));
  CHECK(c(20, 25) / std::sqrt(c(20, 20) * c(25, 25)) == doctest::Approx(std::pow(0.9, 5)).epsilon(0.15));
}

TEST_CASE("variances that differ by no more than chance are held to be one") {
  calx::Random random(2, 4);
  Vector alike(12), apart(12);
  for (int k = 0; k < 12; ++k) {
    double square = 0;
    for (int n = 0; n < 8; ++n) square += std::pow(random.normal(), 2) / 8;
    alike[k] = square, apart[k] = k < 6 ? 0.1 : 1.9;
  }
  CHECK((shrunk_variances(alike, 8).array() - 1).abs().maxCoeff() <
        0.5 * (alike.array() / alike.mean() - 1).abs().maxCoeff());
  CHECK(shrunk_variances(apart, 8)[0] < 0.4);
  CHECK(shrunk_variances(apart, 8).mean() == doctest::Approx(1));
}
