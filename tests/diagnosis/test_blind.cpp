// Studies whose truth the diagnosis does not see. Bounds are those that a method of the rates of the full table
// (README.md) breaks once in a thousand: binomial quantiles, never widened.
#include <doctest/doctest.h>

#include <cmath>

#include "diagnosis/table.hpp"

using namespace calx::diagnosis;

namespace {

constexpr std::uint64_t first_seed = 300000;  // neither for development nor for reporting
constexpr int studies = 200, broken_studies = 48, hard_studies = 56;
/// Rates of the full table.
constexpr double full_control = 0.01, full_right = 0.73, full_wrong = 0.005, full_outside_named = 0.04,
                 full_flagged = 0.83, full_in_set = 0.99, full_pair = 0.35, hard_control = 0.01, hard_wrong = 0.02;

std::vector<Outcome> run(int count, Broken broken, double scatter = 1, bool hard = false) {
  calx::infer::Options options;
  options.nulls = 250;
  std::vector<Outcome> outcomes;
  for (int k = 0; k < count; ++k)
    outcomes.push_back(diagnose_study(first_seed + static_cast<std::uint64_t>(k), options, broken, scatter,
                                      hard ? trouble_of(static_cast<std::uint64_t>(k)) : Trouble::none));
  return outcomes;
}

/// The largest count that a binomial of n and p exceeds with at most one chance in a thousand.
int most(int n, double p) {
  double below = 0;
  for (int k = 0; k <= n; ++k) {
    below += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                      (n - k) * std::log1p(-p));
    if (below >= 0.999) return k;
  }
  return n;
}

bool few(const Rate& rate, double p) { return rate.k <= most(rate.n, p); }
bool many(const Rate& rate, double p) { return rate.n - rate.k <= most(rate.n, 1 - p); }

/// Which rates of the full table are kept.
struct Sound {
  bool controls, right, wrong, outside_named, flagged;
  bool all() const { return controls && right && wrong && outside_named && flagged; }
};

Sound judge(const std::vector<Outcome>& outcomes) {
  const Table t = tabulate(outcomes);
  const Rate false_on_controls{t.control_named.k + t.control_unknown.k, t.control_named.n};
  const Rate wrong{t.single_wrong.k + t.pair_wrong.k, t.single_wrong.n + t.pair_wrong.n};
  return {few(false_on_controls, full_control), many(t.single_right, full_right), few(wrong, full_wrong),
          few(t.outside_named, full_outside_named), many(t.outside_flagged, full_flagged)};
}

}  // namespace

TEST_CASE("blind studies keep the rates of the full table") {
  const std::vector<Outcome> outcomes = run(studies, Broken::no);
  const Table t = tabulate(outcomes);
  MESSAGE("\n", describe(outcomes));
  CHECK(t.most_runs <= 44);
  const Sound sound = judge(outcomes);
  CHECK(sound.controls);
  CHECK(sound.right);
  CHECK(sound.wrong);
  CHECK(sound.outside_named);
  CHECK(sound.flagged);
  CHECK(few({t.in_set.n - t.in_set.k, t.in_set.n}, 1 - full_in_set));
  CHECK(many(t.pair_right, full_pair));
  // What many do in practice names a cause in every study; the diagnosis is worth its trouble.
  CHECK(t.practice_named.share() > 0.95);
  CHECK(t.practice_right.share() < 0.5);
}

TEST_CASE("studies made harder bring silence rather than false names") {
  const std::vector<Outcome> outcomes = run(hard_studies, Broken::no, 1, true);
  const Table t = tabulate(outcomes);
  MESSAGE("\n", describe_troubles(outcomes));
  CHECK(few(t.control_named, hard_control));
  CHECK(few({t.single_wrong.k + t.pair_wrong.k, t.single_wrong.n + t.pair_wrong.n}, hard_wrong));
  CHECK(few(t.outside_named, full_outside_named));
  // Below detection nothing can be named; otherwise much still can.
  CHECK(t.single_right.share() > 0.2);
}

TEST_CASE("a method broken on purpose leaves the rates of the full table") {
  for (Broken broken : {Broken::shuffled_signatures, Broken::no_recalibration, Broken::fit_is_hold_out}) {
    CAPTURE(static_cast<int>(broken));
    CHECK_FALSE(judge(run(broken_studies, broken)).all());
  }
  // Only effects outside the library tell: a quarter of the studies, a third of them named then.
  CHECK_FALSE(judge(run(3 * broken_studies, Broken::no_unknown)).outside_named);
}

TEST_CASE("seed scatter left out of the budget shows where runs scatter") {
  // Runs that scatter four times as much: with the budget, controls stay clean; without it they do not.
  CHECK(judge(run(broken_studies, Broken::no, 4)).controls);
  CHECK_FALSE(judge(run(broken_studies, Broken::no_seed_scatter, 4)).all());
}
