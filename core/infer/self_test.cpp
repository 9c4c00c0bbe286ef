#include "infer/self_test.hpp"

#include <algorithm>
#include <cmath>

#include "infer/heavy_tails.hpp"

namespace calx::infer {

namespace {

Vector normal(Random& random, Eigen::Index size) {
  Vector v(size);
  for (double& x : v) x = random.normal();
  return v;
}

class Draws {
 public:
  Draws(const LinearModel& model, const Options& options) : model_(model), options_(options) {
    const Budget budget = error_budget(model, options);
    systematic_ = Eigen::LLT<Matrix>(budget.systematic).matrixL();
    noise_[0] = Eigen::LLT<Matrix>(budget.fit.noise).matrixL();
    noise_[1] = Eigen::LLT<Matrix>(budget.hold.noise).matrixL();
  }

  /// The model with synthetic measurements; amplitude 0: a control.
  LinearModel operator()(Random& random, std::size_t effect, double amplitude) const {
    LinearModel out = model_;
    const auto rows = model_.base.size();
    Vector mean = model_.base + systematic_.triangularView<Eigen::Lower>() * normal(random, rows);
    mean += model_.sensitivities * (normal(random, model_.u.size()) - model_.u);
    if (amplitude != 0) {
      Vector direction = normal(random, model_.effects[effect].components);
      direction *= amplitude * model_.effects[effect].scale / direction.norm();
      if (model_.effects[effect].one_sided) direction = direction.cwiseAbs();
      const Vector g = model_.signatures[effect] * direction;
      const Matrix shape = shape_columns(model_.observables, g, 1, 1, options_);
      mean += g + shape * normal(random, shape.cols());
    }
    for (int campaign = 0; campaign < 2; ++campaign) {
      Vector noise(rows);
      for (double& x : noise) x = heavy_tailed(random);
      noise = noise_[campaign].triangularView<Eigen::Lower>() * noise;
      misstate_blocks(random, model_.observables, noise);
      for (std::size_t b = 0; b < out.observables.blocks.size(); ++b) {
        Vector& y = campaign == 0 ? out.observables.blocks[b].fit : out.observables.blocks[b].hold;
        if (y.size() != 0) y = (mean + noise).segment(model_.observables.first(b), model_.observables.size(b));
      }
    }
    return out;
  }

 private:
  const LinearModel& model_;
  const Options& options_;
  Matrix systematic_, noise_[2];
};

}  // namespace

SelfTest self_test(const LinearModel& model, const Bank& bank, const std::vector<std::size_t>& effects,
                   const std::vector<double>& amplitudes, int studies, const Options& options) {
  Options plain = options;
  plain.calibration = {};
  const Draws draw(model, options);
  SelfTest test;
  std::vector<std::pair<double, bool>> statements;
  std::uint64_t stream = 1000;
  for (int k = 0; k < studies; ++k) {
    Random random(options.seed, stream++);
    const Diagnosis d = diagnose(draw(random, 0, 0), bank, plain);
    test.controls += 1, test.controls_named += d.named.empty() ? 0 : 1;
    for (double p : d.posterior.inclusion) statements.push_back({p, false});
  }
  for (std::size_t e : effects)
    for (double amplitude : amplitudes) {
      SelfTest::Power power{e, amplitude, 0, 0, 0};
      for (int k = 0; k < studies; ++k) {
        Random random(options.seed, stream++);
        const Diagnosis d = diagnose(draw(random, e, amplitude), bank, plain);
        power.studies += 1;
        power.right += d.named == std::vector<std::size_t>{e} ? 1 : 0;
        power.wrong += !d.named.empty() && d.named != std::vector<std::size_t>{e} ? 1 : 0;
        for (std::size_t c = 0; c < d.posterior.inclusion.size(); ++c)
          statements.push_back({d.posterior.inclusion[c], c == e});
      }
      test.powers.push_back(power);
    }
  test.calibration = learn_isotonic(statements, std::max(10, studies / 2));
  return test;
}

}  // namespace calx::infer
