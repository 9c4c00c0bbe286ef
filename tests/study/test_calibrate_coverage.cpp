// Intervals of a calibration hold the truth as often as they say, on a stand-in of which the truth is known.
#include <doctest/doctest.h>

#include <filesystem>

#include "io/scratch.hpp"
#include "stand_in.hpp"
#include "study/calibrate.hpp"

namespace calx {
namespace {

/// Bounds of a share of which count of n were seen, 95 % (Wilson 1927, J. Am. Stat. Assoc. 22).
std::pair<double, double> wilson(double count, double n) {
  const double z = 1.96, p = count / n, below = 1 + z * z / n, middle = (p + z * z / (2 * n)) / below,
               half = z / below * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {middle - half, middle + half};
}

}  // namespace

TEST_CASE("90 % intervals hold the truth in at least 85 of 100 repetitions") {
  const int repetitions = 100;
  Random truths(20260101, 3);
  int held[2] = {0, 0}, both = 0, held_out = 0;
  double width[2] = {0, 0};
  for (int k = 0; k < repetitions; ++k) {
    const calx_test::Scratch scratch;
    StandInExecutor executor(scratch / "runs");
    const double truth[2] = {truths.uniform(0.2, 0.8), truths.uniform(0.05, 0.35)};
    const Study study = stand_in_study(truth[0], truth[1], 1000 + static_cast<std::uint64_t>(k));
    const Calibration c = calibrate(study, executor, {});
    bool all = true;
    for (std::size_t p = 0; p < 2; ++p) {
      const bool inside = c.parameters[p].q05 <= truth[p] && truth[p] <= c.parameters[p].q95;
      held[p] += inside ? 1 : 0;
      all = all && inside;
      width[p] += c.parameters[p].identifiability / repetitions;
    }
    both += all ? 1 : 0;
    held_out += c.observables[1].agrees ? 1 : 0;
    CHECK(c.runs.size() <= study.budget);
  }
  for (std::size_t p = 0; p < 2; ++p) {
    const auto [low, high] = wilson(held[p], repetitions);
    MESSAGE((p == 0 ? "friction: " : "rolling: "), held[p], " of 100 inside, 95 % interval of the share ", low, " to ",
            high, "; posterior sd over prior sd ", width[p]);
    CHECK(held[p] >= 85);
    // An interval that says nothing would hold the truth, too.
    CHECK(width[p] < 0.5);
  }
  MESSAGE("both inside: ", both, " of 100; held-out density agrees: ", held_out, " of 100");
  CHECK(held_out >= 85);
}

}  // namespace calx
