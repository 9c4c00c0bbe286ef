#include <doctest/doctest.h>

#include "infer/experiment.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

/// A number that only one effect moves, by `strength` per unit of amplitude.
Experiment number_of(const char* name, std::size_t effect, double strength) {
  Experiment x;
  x.name = name;
  x.sd = Vector::Constant(1, 0.1), x.tolerance = Vector::Constant(1, 0.03), x.base = Vector::Zero(1);
  x.sensitivities = Matrix::Zero(1, 1);
  x.signatures.assign(3, Matrix::Zero(1, 1));
  x.signatures[effect](0, 0) = strength;
  return x;
}

}  // namespace

TEST_CASE("of two causes alike, the measurement that only one of them moves is proposed and settles it") {
  LinearModel model = small_model();
  model.signatures[2] = model.signatures[0];  // now nobody can tell rise from bump
  calx::Random random(12, 1);
  for (int campaign = 0; campaign < 2; ++campaign) {
    const Vector y = 2 * model.signatures[0].col(0) + model.observables.sd().cwiseProduct(normal_vector(random, 31));
    for (std::size_t b = 0; b < 2; ++b)
      (campaign == 0 ? model.observables.blocks[b].fit : model.observables.blocks[b].hold) =
          y.segment(model.observables.first(b), model.observables.size(b));
  }
  const Options options;
  const Diagnosis diagnosis = diagnose(model, make_bank(model.observables), options);
  CHECK(diagnosis.verdict == Verdict::ambiguous);
  CHECK(diagnosis.posterior.inclusion[0] > 0.25);
  CHECK(diagnosis.posterior.inclusion[2] > 0.25);
  const std::vector<Experiment> experiments = {number_of("shift gauge", 1, 1), number_of("rise gauge", 0, 1),
                                               number_of("nothing", 1, 0)};
  const std::vector<Proposal> proposals = propose(model, diagnosis, experiments, options);
  CHECK(proposals[0].experiment == 1);
  // Two equal explanations: at most ln 2 between them.
  CHECK(proposals[0].information > 0.4);
  CHECK(proposals[0].clear_verdict > 0.6);
  // It can only show the wider spread of something unknown.
  CHECK(std::abs(proposals[2].information) < 0.2 * proposals[0].information);
  const std::vector<Forecast> forecasts = forecast(model, diagnosis, experiments[1], options);
  CHECK(after_experiment(forecasts, Vector::Constant(1, 2), 3)[0] > 0.9);
  CHECK(after_experiment(forecasts, Vector::Constant(1, 0), 3)[2] > 0.9);
}
