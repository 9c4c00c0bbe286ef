// What a diagnosis advises: each hint from the figures it is made of, and none where there is nothing to say.
#include <doctest/doctest.h>

#include "study/hints.hpp"

using namespace calx;

namespace {

Candidate candidate(const std::string& id, const std::string& parameter, double scale) {
  Candidate c;
  c.info.id = id;
  c.effect.id = id;
  c.effect.scale = scale;
  c.effect.components = 1;
  c.parameter = parameter;
  c.unit = "mm";
  c.lowest = 0, c.highest = 10;
  return c;
}

/// Two effects, one parameter and one observable, with data held out.
struct Made {
  Study study;
  StudyDiagnosis d;
  Made(infer::Verdict verdict, double parameter_off) {
    study.parameters.resize(1);
    study.parameters[0].name = "friction";
    d.library.candidates = {candidate("a.leak", "gap", 1), candidate("b.lag", "lag", 1)};
    d.library.candidates[0].info.rivals = {{"b.lag", "a dropped weight"}, {"c.other", "nothing here"}};
    d.kept = {0, 1};
    for (const Candidate& c : d.library.candidates) d.model.effects.push_back(c.effect);
    d.diagnosis.verdict = verdict;
    d.diagnosis.set = {0, 1};
    d.diagnosis.posterior.fits.resize(2);
    d.diagnosis.posterior.fits[0].high = 2, d.diagnosis.posterior.fits[1].high = 0.5;
    // Their upper ends lie 4 and 2 standard deviations out.
    for (infer::SingleFit& fit : d.diagnosis.posterior.fits) fit.amplitude = infer::Vector::Constant(1, 0.25);
    d.confusion.detectability = {0.5, 1};
    d.confusion.distance = infer::Matrix::Constant(2, 2, 1.5);
    d.u_before = d.u_after = infer::Vector::Constant(1, parameter_off);
    d.measured.has_hold_out = true;
  }
  std::vector<std::string> hints() const { return hints_of(study, d); }
};

}  // namespace

TEST_CASE("where nothing is wrong the hints say what the data exclude, the best seen cause first") {
  const Made made(infer::Verdict::none, 0.5);
  REQUIRE(made.hints().size() == 1);
  CHECK(made.hints()[0] == "These data already exclude (95 %): b.lag beyond lag = 0.5 mm, a.leak beyond gap = 2 mm.");
}

TEST_CASE("what leaves no trace, or is bounded by its prior alone, is excluded by no data") {
  Made made(infer::Verdict::none, 0);
  made.d.confusion.detectability = {0.5, 0.55};  // 1.1 standard deviations at the upper end of b.lag
  REQUIRE(made.hints().size() == 1);
  CHECK(made.hints()[0] == "These data already exclude (95 %): a.leak beyond gap = 2 mm.");
  made.d.diagnosis.posterior.fits[0].amplitude.setZero(), made.d.diagnosis.posterior.fits[0].high = 0;
  made.d.confusion.detectability = {0, 0.55};
  CHECK(made.hints().empty());
}

TEST_CASE("causes that are left are told apart by repeats, or by what their authors name") {
  Made made(infer::Verdict::ambiguous, 0);
  REQUIRE(made.hints().size() == 2);
  // (3 / 1.5)^2 times as many.
  CHECK(made.hints()[0].find("a.leak and b.lag are 1.5 standard errors apart; 4 times as many repeats") == 0);
  CHECK(made.hints()[1] == "a.leak and b.lag are told apart by: a dropped weight.");
  made.d.confusion.distance.setConstant(0.5);
  CHECK(made.hints()[0].find("no number of repeats of these measurements separates them") != std::string::npos);
  made.d.confusion.distance.setConstant(4);
  CHECK(made.hints().size() == 1);
}

TEST_CASE("a parameter that recalibration strains is to be measured by itself") {
  const Made made(infer::Verdict::ambiguous, -2.6);
  CHECK(made.hints().back() ==
        "Measure friction by itself: recalibration puts it 2.6 of its standard deviations below what was expected.");
}

TEST_CASE("data without a held-out part are told to have one") {
  Made made(infer::Verdict::none, 0);
  made.d.measured.has_hold_out = false;
  CHECK(made.hints().back().find("without held-out data no cause can be named") != std::string::npos);
  made.d.measured.has_hold_out = made.d.measured.split_repeats = true;
  CHECK(made.hints().back().find("so far only later repeats are held out") != std::string::npos);
}
