#include <doctest/doctest.h>

#include "infer/isotonic.hpp"

using namespace calx::infer;

TEST_CASE("an over-confident statement is mapped to how often it is true") {
  std::vector<std::pair<double, bool>> statements;
  for (int k = 0; k < 1000; ++k) statements.push_back({0.2, k % 5 == 0}), statements.push_back({0.9, k % 5 < 3});
  const IsotonicMap map = learn_isotonic(statements, 50);
  CHECK(map(0.9) == doctest::Approx(0.6).epsilon(0.01));
  CHECK(map(0.2) == doctest::Approx(0.2).epsilon(0.01));
  CHECK(map(0.99) == map(0.9));
}

TEST_CASE("the map rises, whatever the outcomes, and promises no certainty") {
  std::vector<std::pair<double, bool>> statements;
  for (int k = 0; k < 400; ++k) statements.push_back({k / 400.0, k % 7 < 3 || k > 300});
  const IsotonicMap map = learn_isotonic(statements, 40);
  for (std::size_t k = 1; k < map.observed.size(); ++k) CHECK(map.observed[k] >= map.observed[k - 1]);
  CHECK(map.observed.back() < 1);
  CHECK(IsotonicMap{}(0.37) == 0.37);
}
