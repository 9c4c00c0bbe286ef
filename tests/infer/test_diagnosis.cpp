#include <doctest/doctest.h>

#include <cmath>

#include "infer/self_test.hpp"
#include "infer/small_problem.hpp"
#include "infer/unknown_term.hpp"

using namespace calx::infer;

namespace {

/// Measurements of mean plus noise, in both campaigns.
LinearModel measured(const Vector& mean, std::uint64_t seed) {
  LinearModel model = small_model();
  calx::Random random(seed, 1);
  for (int campaign = 0; campaign < 2; ++campaign) {
    const Vector y = mean + model.observables.sd().cwiseProduct(normal_vector(random, 31));
    for (std::size_t b = 0; b < 2; ++b)
      (campaign == 0 ? model.observables.blocks[b].fit : model.observables.blocks[b].hold) =
          y.segment(model.observables.first(b), model.observables.size(b));
  }
  return model;
}

Diagnosis diagnosed(const LinearModel& model, const Options& options = {}) {
  return diagnose(model, make_bank(model.observables), options);
}

}  // namespace

TEST_CASE("nothing, one effect, and a step that no effect makes each get their verdict") {
  CHECK(diagnosed(measured(Vector::Zero(31), 1)).verdict == Verdict::none);
  const Diagnosis shift = diagnosed(measured(2 * small_signatures()[1], 2));
  CHECK(shift.verdict == Verdict::named);
  CHECK(shift.named == std::vector<std::size_t>{1});
  CHECK(shift.gain.log_score > 3);
  CHECK(shift.after.p > 0.01);
  CHECK(shift.posterior.fits[1].low < 2);
  CHECK(shift.posterior.fits[1].high > 2);

  Vector step = Vector::Zero(31);
  for (int k = 12; k < 30; ++k) step[k] = -2;
  const LinearModel model = measured(step, 3);
  const Bank bank = make_bank(model.observables);
  const Diagnosis unknown = diagnose(model, bank, {});
  CHECK(unknown.verdict == Verdict::unknown);
  const std::vector<UnknownTerm> terms = find_terms(model, bank, unknown, {});
  REQUIRE(terms.size() >= 1);
  CHECK(bank.terms[terms[0].term].family == "step");
  CHECK(terms[0].size == doctest::Approx(-2).epsilon(0.2));
  CHECK(terms[0].stability >= 0.7);
  CHECK(terms[0].words.find("series: a step of -") == 0);
}

TEST_CASE("a displaced curve is told as such, with its displacement along the index") {
  LinearModel model = measured(Vector::Zero(31), 8);
  Block& series = model.observables.blocks[0];
  for (int k = 0; k < 30; ++k) {
    model.base[k] = -std::abs(k - 14.5);
    series.fit[k] -= std::abs(k - 16.5), series.hold[k] -= std::abs(k - 16.5);
  }
  const Bank bank = make_bank(model.observables, model.base);
  const Diagnosis d = diagnose(model, bank, {});
  CHECK(d.verdict == Verdict::unknown);
  const std::vector<UnknownTerm> terms = find_terms(model, bank, d, {});
  REQUIRE(terms.size() >= 1);
  CHECK(bank.terms[terms[0].term].family == "shift");
  CHECK(std::abs(terms[0].size - 2) < 3 * terms[0].size_sd);
  CHECK(terms[0].size_sd < 0.2);
  CHECK(terms[0].words.find("series: displaced by +") == 0);
}

TEST_CASE("a cause that leaves too much of the data is refused, and said to have been") {
  Vector mean = 3 * small_signatures()[1];
  for (int k = 0; k < 6; ++k) mean[k] += 3;
  Options options;
  options.unknown_rival = options.pairs = false;
  const Diagnosis d = diagnosed(measured(mean, 9), options);
  CHECK(d.verdict == Verdict::unknown);
  CHECK(d.named.empty());
  CHECK(d.refused == std::vector<std::size_t>{1});
  CHECK(d.after.p < 0.01);
  CHECK(diagnosed(measured(3 * small_signatures()[1], 9), options).refused.empty());
}

TEST_CASE("nothing is not said to be wrong only where nothing is left as an explanation") {
  Options options;
  options.unknown_rival = false;
  options.name_above = 1.1, options.global_above = -1;  // no name, and a p that always allows to say "none"
  const Diagnosis d = diagnosed(measured(2 * small_signatures()[1], 2), options);
  CHECK(d.set == std::vector<std::size_t>{1});
  CHECK(d.verdict == Verdict::ambiguous);
  CHECK(diagnosed(measured(Vector::Zero(31), 1), options).verdict == Verdict::none);
}

TEST_CASE("a name that the self-test finds not to be probable enough is withdrawn, another one stays") {
  Options options;
  const LinearModel model = measured(3 * small_signatures()[1], 9);
  Diagnosis d = diagnosed(model, options);
  REQUIRE(d.named == std::vector<std::size_t>{1});
  options.calibration = {{0.5, 1}, {0.4, 0.95}};
  calibrate(d, options);
  CHECK(d.named == std::vector<std::size_t>{1});
  CHECK(d.probability[1] > 0.9);
  CHECK(d.probability[1] < 0.951);
  options.calibration = {{0.5, 1}, {0.4, 0.89}};
  calibrate(d, options);
  CHECK(d.verdict == Verdict::ambiguous);
  CHECK(d.named.empty());
  CHECK(d.reason.find("self-test") != std::string::npos);
  d.refused = {1};
  calibrate(d, options);
  CHECK(d.refused.empty());
}

TEST_CASE("the same seed gives the same numbers") {
  const LinearModel model = measured(small_signatures()[1], 4);
  const Diagnosis a = diagnosed(model), b = diagnosed(model);
  CHECK(a.posterior.inclusion == b.posterior.inclusion);
  CHECK(a.before.p == b.before.p);
  CHECK(a.gain.log_score == b.gain.log_score);
}

TEST_CASE("an effect that repeats only itself is not named: held-out data must show it, too") {
  LinearModel model = measured(Vector::Zero(31), 5);
  const Vector shift = 2 * small_signatures()[1];
  for (std::size_t b = 0; b < 2; ++b)
    model.observables.blocks[b].fit += shift.segment(model.observables.first(b), model.observables.size(b));
  CHECK(diagnosed(model).named.empty());
}

TEST_CASE("a gross error is an event and no cause") {
  LinearModel model = measured(Vector::Zero(31), 6);
  model.observables.blocks[0].fit[7] -= 6;  // twelve sd
  const Diagnosis d = diagnosed(model);
  REQUIRE(d.events.size() == 1);
  CHECK(d.events[0].row == 7);
  CHECK(d.events[0].z < -4.5);
  CHECK(d.verdict == Verdict::none);
}

TEST_CASE("the self-test finds strong effects, rarely weak ones, and no cause in controls") {
  const LinearModel model = measured(Vector::Zero(31), 7);
  Options options;
  options.nulls = 200;
  const SelfTest test = self_test(model, make_bank(model.observables), {1}, {0.1, 4}, 20, options);
  CHECK(test.controls_named == 0);
  CHECK(test.powers[0].right <= 2);
  CHECK(test.powers[1].right >= 15);
  CHECK(test.powers[1].wrong == 0);
  CHECK(test.calibration.observed.back() > 0.8);
}
