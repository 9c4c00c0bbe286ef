// Intervals of a calibration hold the truth as often as they say, on a stand-in of which the truth is known.
#include <doctest/doctest.h>

#include <string>

#include "io/scratch.hpp"
#include "stand_in.hpp"
#include "study/calibrate.hpp"

namespace calx {
namespace {

/// Bounds of a share of which count of n were seen, 95 % (Wilson 1927, J. Am. Stat. Assoc. 22).
std::string wilson(double count, double n) {
  const double z = 1.96, p = count / n, below = 1 + z * z / n, middle = (p + z * z / (2 * n)) / below,
               half = z / below * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return std::to_string(static_cast<int>(count)) + " of " + std::to_string(static_cast<int>(n)) +
         " hold the truth; 95 % interval of the share " + format_number(std::round(1000 * (middle - half)) / 1000) +
         " to " + format_number(std::round(1000 * (middle + half)) / 1000);
}

struct Tally {
  double held[2] = {0, 0}, both = 0, held_out = 0;
  double width[2] = {0, 0};  // mean of posterior sd over prior sd
};

/// bias: of the measured angle, deg, that the study does not know of. reduced: the first wave runs a case that is 4 to
/// 7 % off.
Tally repeat(int repetitions, double bias, bool reduced = false) {
  Random truths(20260101, 3);
  Tally out;
  for (int k = 0; k < repetitions; ++k) {
    const calx_test::Scratch scratch;
    StandInExecutor executor(scratch / "runs");
    const double truth[2] = {truths.uniform(0.2, 0.8), truths.uniform(0.05, 0.35)};
    Study study = stand_in_study(truth[0], truth[1], 1000 + static_cast<std::uint64_t>(k), bias);
    if (reduced) {
      study.cases[0].reduced = "coarse.json";
      study.cases[0].reduced_tolerance = 0.05;
    }
    const Calibration c = calibrate(study, executor, {});
    bool all = true;
    for (std::size_t p = 0; p < 2; ++p) {
      const bool inside = c.parameters[p].q05 <= truth[p] && truth[p] <= c.parameters[p].q95;
      out.held[p] += inside ? 1 : 0;
      all = all && inside;
      out.width[p] += c.parameters[p].identifiability / repetitions;
    }
    out.both += all ? 1 : 0;
    out.held_out += c.observables[2].agrees ? 1 : 0;
    CHECK(c.runs.size() <= study.budget);
  }
  return out;
}

}  // namespace

TEST_CASE("90 % intervals hold the truth in at least 85 of 100 repetitions") {
  const int n = 100;
  const Tally t = repeat(n, 0);
  for (std::size_t p = 0; p < 2; ++p) {
    const std::string text = (p == 0 ? "friction: " : "rolling: ") + wilson(t.held[p], n) +
                             "; posterior sd over prior sd " + format_number(std::round(100 * t.width[p]) / 100);
    MESSAGE(text);
    CHECK(t.held[p] >= 85);
    // An interval that says nothing would hold the truth, too.
    CHECK(t.width[p] < 0.4);
  }
  const std::string text =
      "both: " + wilson(t.both, n) + "; the held-out height agrees in " + format_number(t.held_out);
  MESSAGE(text);
  CHECK(t.both >= 85);
  CHECK(t.held_out >= 85);
}

TEST_CASE("with a reduced case in the first wave intervals hold the truth as often") {
  const int n = 40;
  const Tally t = repeat(n, 0, true);
  const std::string text = "both: " + wilson(t.both, n) + "; posterior sd over prior sd " +
                           format_number(std::round(100 * t.width[0]) / 100) + ", " +
                           format_number(std::round(100 * t.width[1]) / 100);
  MESSAGE(text);
  // Of 40 at 90 %, 31 or fewer are seen once in a hundred times.
  CHECK(t.both > 31);
  CHECK(t.width[0] < 0.4);
}

TEST_CASE("an angle measured 4 degrees off, ten times its error, is not calibrated away") {
  // The test of the test: intervals that hold a truth the data contradict would hold anything.
  const int n = 20;
  const Tally t = repeat(n, 4);
  const std::string text = "both: " + wilson(t.both, n);
  MESSAGE(text);
  CHECK(t.both <= 10);
}

}  // namespace calx
