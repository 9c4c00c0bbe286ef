// What a calibration says in cases where the answer is known: what the data tell and what not, runs that fail, reduced
// cases, data that no parameter can explain.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "io/scratch.hpp"
#include "stand_in.hpp"
#include "study/calibrate.hpp"

namespace calx {
namespace {

Calibration run(const Study& study, double fails_above = 1e9) {
  const calx_test::Scratch scratch;
  StandInExecutor executor(scratch / "runs");
  executor.fails_above = fails_above;
  return calibrate(study, executor, {});
}

bool says(const Calibration& c, const std::string& text) {
  for (const std::string& n : c.notes)
    if (n.find(text) != std::string::npos) return true;
  return false;
}

/// Only the observables of these numbers.
Study keep(Study study, const std::vector<std::size_t>& numbers) {
  std::vector<StudyObservable> kept;
  for (const std::size_t k : numbers) kept.push_back(study.observables[k]);
  study.observables = kept;
  return study;
}

}  // namespace

TEST_CASE("runs without a figure are counted, with the reason of the first") {
  const calx_test::Scratch scratch;
  StandInExecutor executor(scratch / "runs");
  executor.flat_below = 0.3;
  const Calibration c = calibrate(stand_in_study(0.5, 0.2, 11), executor, {});
  std::size_t flat = 0, all = 0;
  for (const RunRow& r : c.runs) ++all, flat += r.values[0] < 0.3;
  REQUIRE(flat > 0);
  CHECK(says(c, "\"angle\": " + std::to_string(flat) + " of " + std::to_string(all) +
                    " runs gave no number and are left out; the first: the pile is flat"));
  CHECK(!says(run(stand_in_study(0.5, 0.2, 11)), "gave no number"));
}

TEST_CASE("one figure for two parameters: they are told only together") {
  const Calibration c = run(keep(stand_in_study(0.5, 0.2, 11), {1}));
  REQUIRE(c.confounded.size() == 1);
  // Density falls with both, so that one makes up for the other.
  CHECK(c.confounded[0].correlation < -0.8);
  CHECK(c.correlation(0, 1) == c.confounded[0].correlation);
}

TEST_CASE("a parameter that no figure answers to keeps its prior") {
  Study study = stand_in_study(0.5, 0.2, 12);
  study.parameters.push_back(stand_in_parameter("colour", "/colour", 2, 6));
  study.budget = 60;
  const Calibration c = run(study);
  CHECK(c.parameters[2].identifiability == doctest::Approx(1).epsilon(0.1));
  // Scatter of the runs can look like a slope, but not like more than the prior allows.
  CHECK(std::fabs(c.parameters[2].mean - 4) < c.parameters[2].prior_sd);
  CHECK(c.parameters[0].identifiability < 0.3);
}

TEST_CASE("a normal prior holds a parameter that the data do not tell") {
  Study study = stand_in_study(0.5, 0.2, 12);
  study.parameters.push_back(stand_in_parameter("colour", "/colour", 2, 6));
  study.parameters[2].prior = StudyParameter::Prior::normal;
  study.parameters[2].mean = 3;
  study.parameters[2].sd = 0.25;
  study.budget = 60;
  const Calibration c = run(study);
  CHECK(c.parameters[2].mean == doctest::Approx(3).epsilon(0.02));
  CHECK(c.parameters[2].sd == doctest::Approx(0.25).epsilon(0.1));
  CHECK(c.parameters[2].prior_sd == doctest::Approx(0.25).epsilon(0.01));
}

TEST_CASE("data that no place of the ranges explains are called so") {
  const Calibration c = run(stand_in_study(0.5, 0.2, 13, 40));
  CHECK(says(c, "no place of the ranges is plausible"));
  CHECK_FALSE(c.observables[0].agrees);
  CHECK(c.observables[0].z > 3);  // measured above what is predicted
}

TEST_CASE("waves look at an ever smaller share, and end early when more runs would tell nothing") {
  const Study study = stand_in_study(0.5, 0.2, 14);
  const Calibration c = run(study);
  REQUIRE(c.waves.size() >= 2);
  CHECK(c.waves[0].plausible_share < 0.25);
  CHECK(c.waves.back().plausible_share <= c.waves[0].plausible_share);
  CHECK(c.waves.back().high[0] - c.waves.back().low[0] < 0.5);
  Study rich = study;
  rich.budget = 400;
  rich.seeds = 4;
  const Calibration most = run(rich);
  CHECK(says(most, "the waves ended early"));
  CHECK(most.runs.size() < 350);
}

TEST_CASE("runs that fail are left out, and too many of them end the study") {
  const Study study = stand_in_study(0.3, 0.2, 15);
  const Calibration c = run(study, 0.7);
  std::size_t failed = 0;
  for (const RunRow& r : c.runs) failed += r.error.empty() ? 0 : 1;
  CHECK(failed > 2);
  CHECK(c.parameters[0].q05 < 0.3);
  CHECK(c.parameters[0].q95 > 0.3);
  CHECK_THROWS_WITH_AS(run(study, 0.15), doctest::Contains("one run says: blew up"), Error);
}

TEST_CASE("a reduced case that is some percent off finds the region, the full case the values") {
  Study study = stand_in_study(0.5, 0.2, 16);
  study.cases[0].reduced = "coarse.json";
  study.cases[0].reduced_tolerance = 0.05;
  study.budget = 60;
  const Calibration c = run(study);
  CHECK(c.waves[0].reduced);
  CHECK_FALSE(c.waves[1].reduced);
  CHECK(c.waves[0].plausible_share < 0.9);
  std::size_t reduced = 0;
  for (const RunRow& r : c.runs) reduced += r.reduced ? 1 : 0;
  CHECK(reduced == c.waves[0].runs);
  const double truth[2] = {0.5, 0.2};
  for (std::size_t p = 0; p < 2; ++p) {
    CHECK(std::fabs(c.parameters[p].mean - truth[p]) < 3 * c.parameters[p].sd);
    CHECK(c.parameters[p].identifiability < 0.3);
  }
}

TEST_CASE("runs at the posterior mean confirm what the emulators predict") {
  const Calibration c = run(stand_in_study(0.6, 0.1, 17));
  for (const PredictiveCheck& o : c.observables) {
    REQUIRE(o.confirmed.size() == o.mean.size());
    for (std::size_t k = 0; k < o.mean.size(); ++k)
      CHECK(std::fabs(o.confirmed[k] - o.mean[k]) < 4 * std::hypot(o.sd[k], o.confirmed_sd[k]));
  }
  CHECK_FALSE(says(c, "differ from what was predicted"));
}

TEST_CASE("the same study gives the same bits, another seed others") {
  Study study = stand_in_study(0.5, 0.2, 18);
  const Calibration a = run(study), b = run(study);
  CHECK(a.samples == b.samples);
  CHECK(a.parameters[0].mean == b.parameters[0].mean);
  ++study.seed;
  CHECK(run(study).parameters[0].mean != a.parameters[0].mean);
}

TEST_CASE("a budget too small says what is needed") {
  Study study = stand_in_study(0.5, 0.2, 19);
  study.file = "study.json";
  study.budget = 20;
  CHECK_THROWS_WITH_AS(run(study),
                       "study.json /budget/runs: 20 runs are too few; 1 case with 3 seeds at 7 places needs 21", Error);
}

}  // namespace calx
