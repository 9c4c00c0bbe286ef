#include <doctest/doctest.h>

#include "infer/gain.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

/// Both campaigns drawn from the error budget around the mean, systematic errors each anew.
Gain draw(calx::Random& random, const Vector& mean, const Options& options) {
  LinearModel model = small_model();
  const Budget first = error_budget(model, options);
  const Eigen::LLT<Matrix> root(first.systematic + first.fit.noise);
  const Vector shift = random.normal() * model.sensitivities.col(0);
  for (int campaign = 0; campaign < 2; ++campaign) {
    const Vector y = mean + shift + root.matrixL() * normal_vector(random, 31);
    for (std::size_t b = 0; b < 2; ++b)
      (campaign == 0 ? model.observables.blocks[b].fit : model.observables.blocks[b].hold) =
          y.segment(model.observables.first(b), model.observables.size(b));
  }
  return held_out_gain(model, error_budget(model, options), {{1, Vector::Ones(1), 1}}, options);
}

}  // namespace

TEST_CASE("under the old model the held-out ratio reaches 20 in at most 5 % of studies") {
  calx::Random random(11, 1);
  int large = 0;
  double sum = 0;
  for (int k = 0; k < 300; ++k) {
    const Gain gain = draw(random, Vector::Zero(31), {});
    large += gain.log_score >= 3 ? 1 : 0;
    sum += gain.log_score;
  }
  // Markov's bound with three sd of 300 trials: 15 + 3 * 3.8.
  CHECK(large <= 26);
  CHECK(sum < 0);
}

TEST_CASE("a real effect gains, and lowers the error") {
  calx::Random random(11, 2);
  double before = 0, after = 0;
  for (int k = 0; k < 50; ++k) {
    const Gain gain = draw(random, 1.5 * small_signatures()[1], {});
    CHECK(gain.log_score > 3);
    CHECK(gain.sd > 0);
    before += gain.error_before, after += gain.error_after;
  }
  CHECK(after < 0.7 * before);
}
