#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "infer/design.hpp"

namespace calx {
namespace {

double smallest_distance(const Eigen::MatrixXd& x) {
  double out = 1e9;
  for (Eigen::Index a = 0; a < x.rows(); ++a)
    for (Eigen::Index b = 0; b < a; ++b) out = std::min(out, (x.row(a) - x.row(b)).norm());
  return out;
}

}  // namespace

TEST_CASE("every interval of every dimension has one place of a Latin hypercube") {
  for (const std::size_t n : {2, 7, 25}) {
    const Eigen::MatrixXd x = latin_hypercube(n, 3, 5);
    REQUIRE(x.rows() == static_cast<Eigen::Index>(n));
    for (Eigen::Index k = 0; k < 3; ++k) {
      std::set<long> intervals;
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        CHECK(x(i, k) > 0);
        CHECK(x(i, k) < 1);
        intervals.insert(static_cast<long>(x(i, k) * static_cast<double>(n)));
      }
      CHECK(intervals.size() == n);
    }
  }
}

TEST_CASE("swaps spread the places: the closest two lie farther apart than without them, for each of ten seeds") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    CHECK(smallest_distance(latin_hypercube(16, 2, seed)) >= smallest_distance(random_hypercube(16, 2, seed)));
  // 16 places of a square grid would lie 0.25 apart.
  CHECK(smallest_distance(latin_hypercube(16, 2, 1)) > 0.15);
}

TEST_CASE("the same seed gives the same design, another seed another") {
  CHECK(latin_hypercube(9, 2, 3) == latin_hypercube(9, 2, 3));
  CHECK(latin_hypercube(9, 2, 3) != latin_hypercube(9, 2, 4));
}

TEST_CASE("places are added far from those that are there, in units of the scale") {
  Eigen::MatrixXd line(5, 1), taken(1, 1);
  line << 0, 1, 2, 3, 4;
  taken << 0.2;
  // 4 is farthest from 0.2; then 2 is, 2 away from 4 and 1.8 from 0.2.
  CHECK(spread_out(line, taken, 2, Eigen::VectorXd::Ones(1)) == std::vector<std::size_t>{4, 2});
  Eigen::MatrixXd plane(2, 2), origin = Eigen::MatrixXd::Zero(1, 2);
  plane << 0, 3, 2, 0;
  Eigen::Vector2d scale(1, 1);
  CHECK(spread_out(plane, origin, 1, scale) == std::vector<std::size_t>{0});
  scale << 1, 2;
  CHECK(spread_out(plane, origin, 1, scale) == std::vector<std::size_t>{1});
  CHECK(spread_out(plane, origin, 9, scale).size() == 2);
}

}  // namespace calx
