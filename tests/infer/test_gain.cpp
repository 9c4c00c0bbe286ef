#include <doctest/doctest.h>

#include <cmath>

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

TEST_CASE("the sd of a gain is that of repeated held-out campaigns, if the extended model is right") {
  calx::Random random(11, 3);
  LinearModel model = small_model();
  const Options options;
  const Vector y = 1.5 * small_signatures()[1] + model.observables.sd().cwiseProduct(normal_vector(random, 31));
  for (std::size_t b = 0; b < 2; ++b)
    model.observables.blocks[b].fit = model.observables.blocks[b].hold =
        y.segment(model.observables.first(b), model.observables.size(b));
  Budget budget = error_budget(model, options);
  const std::vector<Part> parts = {{1, Vector::Constant(1, 1.5), 1}};
  const double stated = held_out_gain(model, budget, parts, options).sd;

  // Both campaigns as one Gaussian: shared through the parameters, the rest drawn for each. Then the second given the
  // first.
  const Freedom freedom = freedom_of(model, parts, options);
  Matrix columns(31, model.sensitivities.cols() + freedom.columns.cols());
  columns << model.sensitivities, freedom.columns;
  const Matrix shared = columns * columns.transpose(), own = budget.systematic + freedom.own;
  const Matrix gain = shared * Matrix(shared + own + budget.fit.noise).inverse();
  const Matrix left = shared + own + budget.hold.noise - gain * shared;
  const Eigen::LLT<Matrix> root(left);
  const Vector mean = gain * budget.fit.y;
  constexpr int draws = 2000;
  Vector scores(draws);
  for (double& score : scores) {
    budget.hold.y = mean + root.matrixL() * normal_vector(random, 31);
    score = held_out_gain(model, budget, parts, options).log_score;
  }
  const Vector off = scores.array() - scores.mean();
  const double variance = off.squaredNorm() / draws;
  // The relative error of a variance is sqrt((kurtosis - 1) / draws), half of it that of an sd; three times that.
  const double kurtosis = off.array().pow(4).mean() / (variance * variance);
  CHECK(std::abs(std::sqrt(variance) / stated - 1) < 1.5 * std::sqrt((kurtosis - 1) / draws));
}
