#include "infer/self_test.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <thread>

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

/// Runs tasks 0 .. count - 1 on all cores. Each writes its own place, so that their order does not show. Throws what
/// the first of those that throw has thrown.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> thrown(count);
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) try {
          task(i);
        } catch (...) {
          thrown[i] = std::current_exception();
        }
    });
  for (std::thread& t : threads) t.join();
  for (const std::exception_ptr& e : thrown)
    if (e) std::rethrow_exception(e);
}

}  // namespace

SelfTest self_test(const LinearModel& model, const Bank& bank, const std::vector<std::size_t>& effects,
                   const std::vector<double>& amplitudes, int studies, const Options& options) {
  Options plain = options;
  plain.calibration = {};
  // Enough for the thresholds of the decision, and the self-test is hundreds of diagnoses.
  plain.nulls = std::min(options.nulls, 200);
  const Draws draw(model, options);
  SelfTest test;
  test.controls = studies;
  for (const std::size_t e : effects)
    for (const double amplitude : amplitudes) test.powers.push_back({e, amplitude, studies, 0, 0});
  const auto per_row = static_cast<std::size_t>(studies);
  std::vector<Diagnosis> all(per_row * (1 + test.powers.size()));
  in_parallel(all.size(), [&](std::size_t i) {
    Random random(options.seed, 1000 + i);
    const bool control = i < per_row;
    const SelfTest::Power* p = control ? nullptr : &test.powers[i / per_row - 1];
    Diagnosis d = diagnose(draw(random, p ? p->effect : 0, p ? p->amplitude : 0), bank, plain);
    all[i].named = d.named;
    all[i].posterior.inclusion = d.posterior.inclusion;
  });
  std::vector<std::pair<double, bool>> statements;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Diagnosis& d = all[i];
    SelfTest::Power* p = i < per_row ? nullptr : &test.powers[i / per_row - 1];
    if (!p) {
      test.controls_named += d.named.empty() ? 0 : 1;
    } else {
      const bool right = d.named == std::vector<std::size_t>{p->effect};
      p->right += right ? 1 : 0;
      p->wrong += !d.named.empty() && !right ? 1 : 0;
    }
    for (std::size_t c = 0; c < d.posterior.inclusion.size(); ++c)
      statements.push_back({d.posterior.inclusion[c], p && c == p->effect});
  }
  test.calibration = learn_isotonic(statements, std::max(10, studies / 2));
  return test;
}

}  // namespace calx::infer
