// Parameters fitted by real runs, and the confirmation by runs with new seeds, on the stand-in of a heap and a hopper.
#include <doctest/doctest.h>

#include <cmath>

#include "io/scratch.hpp"
#include "stand_in.hpp"
#include "study/confirm.hpp"

namespace calx {
namespace {

using infer::Vector;

/// A study measured at friction 0.6 and rolling friction 0.15, made linear at the middle of the ranges.
struct Fixture {
  Fixture() : study(stand_in_study(0.6, 0.15, 5)), executor(scratch / "runs") {
    // Held out as well as fitted, as in a second campaign.
    const std::size_t count = study.observables.size();
    for (std::size_t k = 0; k < count; ++k) {
      StudyObservable again = study.observables[k];
      if (again.use != StudyObservable::Use::fit) continue;
      again.name += " again", again.use = StudyObservable::Use::hold_out;
      study.observables.push_back(again);
    }
    d.measured = measured_blocks(study);
    simulator = std::make_unique<StudySimulator>(study, d.measured.readings, d.library, executor, sink, d.ledger);
    d.model = infer::linearise(d.measured.observables, {}, *simulator, d.options);
    d.bank = infer::make_bank(d.model.observables, d.model.base);
    d.diagnosis = infer::diagnose(d.model, d.bank, d.options);
    d.diagnosis.gain.log_score = 20;
  }
  /// Standardised from friction and rolling friction.
  Vector at(double friction, double rolling) const {
    Vector u(2);
    u << (friction - 0.5) / prior_sd(study.parameters[0]), (rolling - 0.2) / prior_sd(study.parameters[1]);
    return u;
  }
  const calx_test::Scratch scratch;
  Study study;
  StandInExecutor executor;
  ProgressSink sink;
  StudyDiagnosis d;
  std::unique_ptr<StudySimulator> simulator;
};

}  // namespace

TEST_CASE("runs fit the parameters where the plane does not reach") {
  Fixture f;
  // The discharge bends with friction: from here the plane alone ends elsewhere.
  const RealFit fit = fit_by_runs(f.d, *f.simulator, {f.at(0.2, 0.35), {}, {}}, 6, 6);
  const std::vector<double> found = f.simulator->values(fit.model.u);
  CHECK(found[0] == doctest::Approx(0.6).epsilon(0.2));
  CHECK(found[1] == doctest::Approx(0.15).epsilon(0.25));
  CHECK(fit.sd.empty());
}

TEST_CASE("a fit by runs keeps the best place it was at, even if that is where it began") {
  Fixture f;
  const RealFit still = fit_by_runs(f.d, *f.simulator, {f.at(0.6, 0.15), {}, {}}, 0, 4);
  CHECK((still.model.u - f.at(0.6, 0.15)).norm() == 0);
}

TEST_CASE("runs where the data are pass the fit test, however far the plane is from them, and runs elsewhere do not") {
  Fixture f;
  const RealFit fit = fit_by_runs(f.d, *f.simulator, {f.at(0.6, 0.15), {}, {}}, 0, 5);
  f.d.model.base.array() += 100;
  CHECK(check_runs(f.d, fit, 5).p > 0.01);
  const RealFit far = fit_by_runs(f.d, *f.simulator, {f.at(0.3, 0.3), {}, {}}, 0, 5);
  CHECK(check_runs(f.d, far, 5).p < 0.01);
}

TEST_CASE("an extension is confirmed where its runs are nearer to the held-out data, and not otherwise") {
  Fixture f;
  const RealModel far{f.at(0.3, 0.3), {}, {}}, near{f.at(0.6, 0.15), {}, {}};
  const Confirmation good = confirm_by_runs(f.d, *f.simulator, far, near, 5);
  CHECK(good.passed);
  CHECK(good.log_score > 10);
  CHECK(good.error_after < 0.5 * good.error_before);
  CHECK(good.agreement > 1e-6);
  const Confirmation bad = confirm_by_runs(f.d, *f.simulator, near, far, 5);
  CHECK_FALSE(bad.passed);
  CHECK(bad.log_score == doctest::Approx(-good.log_score));
  // Nothing gained is not confirmed, whatever little the algebra promised.
  f.d.diagnosis.gain.log_score = 0.01;
  CHECK_FALSE(confirm_by_runs(f.d, *f.simulator, near, near, 5).passed);
}

TEST_CASE("runs contradict the algebra where they are elsewhere and farther from the data, not where they are nearer") {
  Fixture f;
  const RealModel far{f.at(0.3, 0.3), {}, {}}, near{f.at(0.6, 0.15), {}, {}};
  CHECK_FALSE(confirm_by_runs(f.d, *f.simulator, far, near, 5).contradicted);
  f.d.model.base.array() += 100;
  const Confirmation nearer = confirm_by_runs(f.d, *f.simulator, far, near, 5);
  CHECK(nearer.agreement < 1e-3);
  CHECK(nearer.error_foretold > nearer.error_after);
  CHECK_FALSE(nearer.contradicted);
  f.d.model.base.array() -= 100;
  // The algebra has `far` where the data are; its runs are elsewhere.
  f.d.model.base += f.d.diagnosis.budget.hold.y - (f.d.model.base + f.d.model.sensitivities * (far.u - f.d.model.u));
  const Confirmation farther = confirm_by_runs(f.d, *f.simulator, near, far, 5);
  CHECK(farther.error_foretold < 0.1);
  CHECK(farther.contradicted);
}

}  // namespace calx
