// What a self-test says of data that hide nothing, or an effect that is far above or far below the noise.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "infer/self_test.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

constexpr int studies = 40;

SelfTest tested(LinearModel model, const std::vector<double>& amplitudes) {
  model.signature_variance.assign(model.effects.size(), 0);
  return self_test(model, make_bank(model.observables), {2}, amplitudes, studies, {});
}

}  // namespace

TEST_CASE(
    "a strong effect is named, a faint one and none at all are not, and stated probabilities rise with the truth") {
  const SelfTest test = tested(small_model(), {0.01, 12});
  CHECK(test.controls == studies);
  CHECK(test.controls_named == 0);
  REQUIRE(test.powers.size() == 2);
  CHECK(test.powers[0].right == 0);
  CHECK(test.powers[0].wrong == 0);
  CHECK(test.powers[1].right > 0.8 * studies);
  CHECK(test.powers[1].wrong <= 1);
  CHECK(test.calibration(0.99) > 0.8);
  CHECK(test.calibration(0.01) < 0.1);
}

TEST_CASE("the threads that share the work leave no trace") {
  const SelfTest a = tested(small_model(), {3}), b = tested(small_model(), {3});
  CHECK(a.powers[0].right == b.powers[0].right);
  CHECK(a.calibration.stated == b.calibration.stated);
  CHECK(a.calibration.observed == b.calibration.observed);
}

TEST_CASE("an error in one of the studies reaches the caller") {
  LinearModel model = small_model();
  model.base_weight = -100;  // no covariance has a negative variance
  CHECK_THROWS_AS(tested(model, {1}), calx::Error);
}
