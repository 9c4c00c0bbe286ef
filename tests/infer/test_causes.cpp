#include <doctest/doctest.h>

#include <cmath>

#include "infer/causes.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

double log_normal(const Vector& r, const Matrix& c) {
  return -0.5 * r.dot(c.ldlt().solve(r)) - 0.5 * std::log(c.determinant());
}

}  // namespace

TEST_CASE("without tolerance the odds of an effect are the closed form of a scale mixture") {
  // BF = v / s exp(m^2 / 2 v^2), twice the normal integral of m / v where one-sided; v^2 = 1 / (g^2 + 1 / s^2).
  calx::Random random(5, 1);
  const Vector r = 1.5 * normal_vector(random, 12);
  const Metric metric(Matrix::Identity(12, 12), r);
  for (bool one_sided : {false, true}) {
    Signature s;
    s.columns = normal_vector(random, 12), s.shape = {Matrix(12, 0)}, s.scale = 0.7, s.one_sided = one_sided;
    double mixture = 0;
    for (double m : {0.25, 0.5, 1.0, 2.0}) {
      const double scale = m * 0.7, v = 1 / std::sqrt(s.columns.squaredNorm() + 1 / (scale * scale));
      const double mean = v * v * s.columns.col(0).dot(r);
      mixture += v / scale * std::exp(0.5 * mean * mean / (v * v)) *
                 (one_sided ? std::erfc(-mean / v / std::sqrt(2.0)) : 1) / 4;
    }
    // Trapezoids of h = 1/15 sd at most: at the border of a one-sided prior h^2 / 12 times the slope, 0.4 per sd at
    // most of a density of one, is left: 1.5e-4.
    CHECK(std::abs(fit_single(s, metric).odds - std::log(mixture)) < 2e-4);
  }
}

TEST_CASE("a vector of which one direction is not known is as odd as its other component alone, to either side") {
  calx::Random random(7, 1);
  const Vector r = 1.5 * normal_vector(random, 12);
  const Metric metric(Matrix::Identity(12, 12), r);
  Signature scalar;
  scalar.columns = normal_vector(random, 12), scalar.shape = {Matrix(12, 0)}, scalar.scale = 0.7;
  const SingleFit alone = fit_single(scalar, metric);
  for (int known : {0, 1}) {
    Signature vector = scalar;
    vector.columns = Matrix::Zero(12, 2);
    vector.columns.col(known) = scalar.columns;
    vector.shape = {Matrix(12, 0), Matrix(12, 0)};
    const SingleFit fit = fit_single(vector, metric);
    CHECK(std::abs(fit.odds - alone.odds) < 4e-4);  // twice the bound above
    CHECK(fit.amplitude[1 - known] == 0);
    CHECK(fit.amplitude[known] * alone.amplitude[0] > 0);
  }
}

TEST_CASE("with tolerance the odds are the integral of dense densities over the amplitude") {
  const LinearModel model = small_model();
  calx::Random random(6, 1);
  Options options;
  const Matrix s = Matrix::Identity(31, 31);
  const Vector r = 3 * model.signatures[1].col(0) + normal_vector(random, 31);
  const Metric metric(s, r);
  const Signature signature = whiten_signature(model, 1, metric, options);
  double sum = 0;
  const double step = 0.01, reference = log_normal(r, s);
  for (double factor : {0.5, 1.0, 2.0})
    for (double a = -10; a < 14; a += step) {
      double prior = 0;
      for (double m : {0.25, 0.5, 1.0, 2.0})
        prior += std::exp(-0.5 * a * a / (m * m)) / (m * std::sqrt(2 * 3.14159265358979323846)) / 4;
      const Matrix b = factor * a * signature.shape[0];
      const Matrix c = s + b * b.transpose();
      sum += step / 3 * prior * std::exp(log_normal(r - a * model.signatures[1].col(0), c) - reference);
    }
  const SingleFit fit = fit_single(signature, metric);
  // Both sums resolve a smooth density that has died away at their ends, where trapezoids converge faster than any
  // power of the step; the grid ends at 16 sd of the amplitude without tolerance, and what lies beyond is below 1e-6.
  CHECK(std::abs(fit.odds - std::log(sum)) < 1e-4);
  CHECK(fit.low < 3);
  CHECK(fit.high > 3);
}

TEST_CASE("ninety percent intervals hold the amplitude nine times in ten") {
  const LinearModel model = small_model();
  Options options;
  options.shape = 0;
  calx::Random random(7, 1);
  int inside = 0;
  const int studies = 400;
  for (int k = 0; k < studies; ++k) {
    const double truth = random.normal();  // as the prior of scale 1
    const Metric metric(Matrix::Identity(31, 31), truth * model.signatures[1].col(0) + normal_vector(random, 31));
    const SingleFit fit = fit_single(whiten_signature(model, 1, metric, options), metric);
    inside += truth >= fit.low && truth <= fit.high ? 1 : 0;
  }
  // 400 trials at 0.9: sd 6, so that four sd are 24.
  CHECK(std::abs(inside - 360) <= 24);
}

TEST_CASE("a pair is preferred where both act, and finds both amplitudes") {
  const LinearModel model = small_model();
  Options options;
  options.shape = 0.05;
  calx::Random random(8, 1);
  const Metric metric(Matrix::Identity(31, 31),
                      2 * model.signatures[1].col(0) + 4 * model.signatures[2].col(0) + normal_vector(random, 31));
  const Signature a = whiten_signature(model, 1, metric, options), b = whiten_signature(model, 2, metric, options);
  const SingleFit fit_a = fit_single(a, metric), fit_b = fit_single(b, metric);
  const PairFit pair = fit_pair(a, b, fit_a, fit_b, metric);
  CHECK(pair.odds > fit_a.odds + 5);
  CHECK(pair.odds > fit_b.odds + 5);
  // Three posterior sd: of the inverse information of both signatures, and of a tolerance of at most 2 * 0.05.
  Matrix g(31, 2);
  g << model.signatures[1], model.signatures[2];
  const Matrix v = (g.transpose() * g).inverse();
  CHECK(std::abs(pair.first[0] - 2) < 3 * std::sqrt(v(0, 0) + std::pow(0.1 * 2, 2)));
  CHECK(std::abs(pair.second[0] - 4) < 3 * std::sqrt(v(1, 1) + std::pow(0.1 * 4, 2)));
}
