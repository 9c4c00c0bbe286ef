// Which spheres share a grid: what levels are chosen for typical mixes of reach.
#include <doctest/doctest.h>

#include <cmath>

#include "neighbour/cell_levels.hpp"

using namespace calx;

namespace {

std::vector<double> levels(const std::vector<std::pair<double, std::uint64_t>>& reach_and_count) {
  const ReachClasses classes(reach_and_count.front().first, reach_and_count.back().first);
  std::vector<ReachClasses::Class> found(classes.class_count());
  for (const auto& r : reach_and_count) {
    ReachClasses::Class& c = found[classes.class_of(r.first)];
    c.count += r.second;
    c.largest = std::max(c.largest, r.first);
  }
  return choose_levels(found);
}

}  // namespace

TEST_CASE("classes rise with reach and are few however wide the range") {
  for (const double largest : {1e-3, 1.01e-3, 2e-3, 0.05, 1e3}) {
    const ReachClasses classes(1e-3, largest);
    CHECK(classes.class_count() <= ReachClasses::kMost);
    CHECK(classes.class_of(1e-3) == 0);
    CHECK(classes.class_of(largest) == classes.class_count() - 1);
    std::uint32_t before = 0;
    for (int k = 0; k <= 100; ++k) {
      const std::uint32_t c = classes.class_of(1e-3 + (largest - 1e-3) * k / 100);
      CHECK(c >= before);
      before = c;
    }
  }
  CHECK(ReachClasses(1e-3, 1e-3).class_count() == 1);
  CHECK(ReachClasses(0, 0).class_count() == 1);
}

TEST_CASE("spheres of one size share a grid; a few far-reaching ones get their own") {
  CHECK(levels({{1.1e-3, 100000}}) == std::vector<double>{1.1e-3});
  CHECK(levels({{1.1e-3, 99000}, {2e-3, 1000}}) == std::vector<double>{1.1e-3, 2e-3});
  CHECK(levels({{1e-3, 100000}, {5e-3, 800}}) == std::vector<double>{1e-3, 5e-3});
  // A few of nearly the same reach are not worth a grid.
  CHECK(levels({{1e-3, 100000}, {1.02e-3, 50}}) == std::vector<double>{1.02e-3});
  // Ten sizes over a decade: more than one grid, fewer than ten.
  std::vector<std::pair<double, std::uint64_t>> mix;
  for (int k = 0; k < 10; ++k) mix.emplace_back(1e-3 * std::pow(10.0, k / 9.0), 100000 / (1 << k));
  const auto chosen = levels(mix);
  CHECK(chosen.size() > 1);
  CHECK(chosen.size() < 10);
  CHECK(chosen.back() == mix.back().first);
}
