#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "base/random.hpp"
#include "infer/design.hpp"
#include "infer/emulator.hpp"

namespace calx {
namespace {

/// The formulas written out once more: every run is a row of its own, and the covariance is inverted as a whole.
struct WrittenOut {
  Eigen::MatrixXd x;  // one row a run
  Eigen::VectorXd y;  // standardised as the emulator does, by the means of places
  std::vector<Eigen::Index> place;
  double shift = 0, scale = 1;

  static double covariance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& h) {
    const Eigen::Index d = a.size();
    double square = 0, trend = 1;
    for (Eigen::Index k = 0; k < d; ++k) {
      const double difference = (a(k) - b(k)) / std::exp(h(k));
      square += difference * difference;
      trend += (a(k) - 0.5) * (b(k) - 0.5);
    }
    const double r = std::sqrt(square), s = std::sqrt(5.0) * r;
    return 100 * trend + std::exp(2 * h(d)) * (1 + s + 5 * r * r / 3) * std::exp(-s);
  }
  Eigen::MatrixXd matrix(const Eigen::VectorXd& h) const {
    Eigen::MatrixXd out(x.rows(), x.rows());
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      for (Eigen::Index j = 0; j < x.rows(); ++j) {
        out(i, j) = covariance(x.row(i).transpose(), x.row(j).transpose(), h);
        if (place[static_cast<std::size_t>(i)] == place[static_cast<std::size_t>(j)]) out(i, j) += 1e-8;
        if (i == j) out(i, j) += std::exp(2 * h(h.size() - 1));
      }
    return out;
  }
  double log_density(const Eigen::VectorXd& h) const {
    const Eigen::MatrixXd k = matrix(h);
    return -0.5 * y.dot(k.inverse() * y) - 0.5 * std::log(k.determinant());
  }
  Estimate at(const Eigen::VectorXd& where, const Eigen::VectorXd& h) const {
    Eigen::VectorXd c(x.rows());
    for (Eigen::Index i = 0; i < x.rows(); ++i) c(i) = covariance(where, x.row(i).transpose(), h);
    const Eigen::MatrixXd inverse = matrix(h).inverse();
    return {shift + scale * c.dot(inverse * y), scale * scale * (covariance(where, where, h) - c.dot(inverse * c))};
  }
};

struct Data {
  Eigen::MatrixXd x;
  std::vector<std::vector<double>> values;
};

/// sin and a slope in the first of two dimensions; runs scatter by noise.
Data wavy(std::size_t places, std::size_t runs, double noise, std::uint64_t seed) {
  Data out;
  out.x = latin_hypercube(places, 2, seed);
  Random random(seed, 1);
  for (Eigen::Index k = 0; k < out.x.rows(); ++k) {
    out.values.emplace_back();
    for (std::size_t r = 0; r < runs; ++r)
      out.values.back().push_back(10 + 3 * std::sin(4 * out.x(k, 0)) + 2 * out.x(k, 1) + noise * random.normal());
  }
  return out;
}

WrittenOut written_out(const Data& data, const Emulator& e) {
  WrittenOut out;
  std::size_t count = 0;
  for (const auto& v : data.values) count += v.size();
  out.x.resize(static_cast<Eigen::Index>(count), data.x.cols());
  out.y.resize(static_cast<Eigen::Index>(count));
  const Eigen::VectorXd& means = e.places_mean();
  out.shift = means.mean();
  out.scale = std::sqrt((means.array() - out.shift).square().sum() / static_cast<double>(means.size() - 1));
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < data.x.rows(); ++k)
    for (const double v : data.values[static_cast<std::size_t>(k)]) {
      out.x.row(row) = data.x.row(k);
      out.y(row) = (v - out.shift) / out.scale;
      out.place.push_back(k);
      ++row;
    }
  return out;
}

}  // namespace

TEST_CASE("predictions are those of the textbook, with every run a row of its own") {
  const Data data = wavy(7, 3, 0.3, 2);
  const Emulator e(data.x, data.values);
  const WrittenOut w = written_out(data, e);
  for (const double a : {0.1, 0.45, 0.9}) {
    const Eigen::Vector2d where(a, 1 - 0.7 * a);
    const Estimate ours = e.at(where), theirs = w.at(where, e.log_parameters());
    // Rounding of matrices of condition 1e5.
    CHECK(ours.mean == doctest::Approx(theirs.mean).epsilon(1e-7));
    CHECK(ours.variance == doctest::Approx(e.inflation() * theirs.variance).epsilon(1e-6));
  }
}

TEST_CASE("the density of means and scatter is that of all runs, but for a constant") {
  const Data data = wavy(6, 3, 0.3, 4);
  const Emulator e(data.x, data.values);
  const WrittenOut w = written_out(data, e);
  const auto difference = [&](const Eigen::VectorXd& h) {
    const double prior = -0.5 * h.head(2).squaredNorm() - 0.125 * h(2) * h(2);
    return e.log_density(h) - prior - w.log_density(h);
  };
  Eigen::VectorXd one(4), two(4);
  one << 0.1, -0.3, -0.2, -1.5;
  two << -0.8, 0.9, 0.6, -0.7;
  CHECK(difference(one) == doctest::Approx(difference(two)).epsilon(1e-5));
  CHECK(std::fabs(e.log_density(one) - e.log_density(two)) > 0.5);
}

TEST_CASE("leave-one-out is what the other places say with the same lengths") {
  const Data data = wavy(8, 2, 0.2, 6);
  const Emulator e(data.x, data.values);
  const std::vector<Estimate> left_out = e.leave_one_out();
  for (const Eigen::Index gone : {0, 5}) {
    WrittenOut w = written_out(data, e);
    Data rest;
    rest.x.resize(7, 2);
    for (Eigen::Index k = 0, to = 0; k < 8; ++k) {
      if (k == gone) continue;
      rest.x.row(to++) = data.x.row(k);
      rest.values.push_back(data.values[static_cast<std::size_t>(k)]);
    }
    // Standardised as with all places.
    WrittenOut others = written_out(rest, e);
    others.shift = w.shift;
    others.scale = w.scale;
    Eigen::Index row = 0;
    for (const auto& runs : rest.values)
      for (const double v : runs) others.y(row++) = (v - w.shift) / w.scale;
    const Eigen::VectorXd& h = e.log_parameters();
    const Estimate theirs = others.at(data.x.row(gone).transpose(), h);
    const double noise = w.scale * std::exp(h(3));
    CHECK(left_out[static_cast<std::size_t>(gone)].mean == doctest::Approx(theirs.mean).epsilon(1e-6));
    CHECK(left_out[static_cast<std::size_t>(gone)].variance ==
          doctest::Approx(theirs.variance + noise * noise / 2).epsilon(1e-5));
  }
}

TEST_CASE("runs without scatter are interpolated, and a straight line is continued") {
  Data data = wavy(15, 1, 0, 3);
  const Emulator e(data.x, data.values);
  for (Eigen::Index k = 0; k < 15; ++k)
    CHECK(e.at(data.x.row(k).transpose()).mean ==
          doctest::Approx(data.values[static_cast<std::size_t>(k)][0]).epsilon(2e-3));
  Data line = data;
  for (Eigen::Index k = 0; k < 15; ++k)
    line.values[static_cast<std::size_t>(k)] = {5 - 3 * data.x(k, 0) + data.x(k, 1)};
  CHECK(Emulator(line.x, line.values).at(Eigen::Vector2d(1.4, -0.3)).mean ==
        doctest::Approx(5 - 4.2 - 0.3).epsilon(2e-3));
}

TEST_CASE("the scatter of a run is found from runs that share a place") {
  // 30 places of 4 runs: 90 degrees of freedom, so that the sd is known to 7.5 %; three times that.
  const Data data = wavy(30, 4, 0.5, 8);
  CHECK(Emulator(data.x, data.values).noise_sd() == doctest::Approx(0.5).epsilon(0.225));
}

TEST_CASE("90 % intervals of the emulator hold new places in 90 % of cases") {
  int held = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const Data data = wavy(16, 2, 0.2, seed);
    const Emulator e(data.x, data.values);
    const Eigen::MatrixXd asked = random_hypercube(8, 2, seed + 500);
    for (Eigen::Index k = 0; k < asked.rows(); ++k, ++all) {
      const Estimate s = e.at(asked.row(k).transpose());
      const double truth = 10 + 3 * std::sin(4 * asked(k, 0)) + 2 * asked(k, 1);
      held += std::fabs(s.mean - truth) < 1.645 * std::sqrt(s.variance) ? 1 : 0;
    }
  }
  // 200 cases, those of one emulator not independent: binomial sd 2 %, doubled for that; the variance is only ever
  // raised, so there is no upper bound.
  MESSAGE(held, " of ", all);
  CHECK(held >= 0.82 * all);
}

TEST_CASE("a cheaper model in the trend carries a shape that few places could not show") {
  const auto cheap = [](double u) { return std::sin(12 * u); };
  const Eigen::MatrixXd x = latin_hypercube(7, 1, 2);
  Eigen::MatrixXd trend(7, 1);
  std::vector<std::vector<double>> values;
  for (Eigen::Index k = 0; k < 7; ++k) {
    trend(k, 0) = cheap(x(k, 0));
    values.push_back({4 + 2 * cheap(x(k, 0)) + 0.5 * x(k, 0)});
  }
  double with = 0, without = 0;
  const Emulator both(x, values, trend), alone(x, values);
  for (int k = 0; k < 50; ++k) {
    const double u = (k + 0.5) / 50, truth = 4 + 2 * cheap(u) + 0.5 * u;
    const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, u), t = Eigen::VectorXd::Constant(1, cheap(u));
    with = std::max(with, std::fabs(both.at(at, t).mean - truth));
    without = std::max(without, std::fabs(alone.at(at).mean - truth));
  }
  CHECK(with < 0.02);
  CHECK(without > 0.5);
}

TEST_CASE("sizes that do not fit and values that are not finite are refused") {
  const Data data = wavy(5, 2, 0.1, 1);
  auto values = data.values;
  values[2][1] = std::nan("");
  CHECK_THROWS_AS(Emulator(data.x, values), std::invalid_argument);
  values = data.values;
  values.pop_back();
  CHECK_THROWS_AS(Emulator(data.x, values), std::invalid_argument);
  values = data.values;
  values[0].clear();
  CHECK_THROWS_AS(Emulator(data.x, values), std::invalid_argument);
  CHECK_THROWS_AS(Emulator(data.x, data.values).at(Eigen::VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace calx
