#include <doctest/doctest.h>

#include <cmath>

#include "infer/diagnosis.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

/// base 10 + 3 u on the single number, effects as the signatures, the bump quadratic in its amplitude.
class SmallSimulator : public Simulator {
 public:
  explicit SmallSimulator(double scatter) : scatter_(scatter) {}
  int parameters() const override { return 1; }
  Matrix run(const std::vector<RunPoint>& points) override {
    runs += static_cast<int>(points.size());
    Matrix out(31, static_cast<Eigen::Index>(points.size()));
    for (std::size_t k = 0; k < points.size(); ++k) {
      calx::Random random(points[k].seed, 9);
      Vector y = scatter_ * normal_vector(random, 31);
      y.array() += 10;
      y[30] += 3 * points[k].u[0];
      if (points[k].effect >= 0) {
        const double a = points[k].amplitude[0];
        y += (points[k].effect == 2 ? a * a : a) * small_signatures()[static_cast<std::size_t>(points[k].effect)];
      }
      out.col(static_cast<Eigen::Index>(k)) = y;
    }
    return out;
  }
  Vector instrument(const RunPoint& point) override { return point.amplitude[0] * small_signatures()[1]; }
  int runs = 0;

 private:
  double scatter_;
};

Observables measured(double single) {
  Observables all = small_observables();
  for (Vector* y : {&all.blocks[0].fit, &all.blocks[0].hold}) y->setConstant(10);
  for (Vector* y : {&all.blocks[1].fit, &all.blocks[1].hold}) y->setConstant(single);
  return all;
}

}  // namespace

TEST_CASE("a linear simulator gives its plane back, re-based where the data are, in the planned number of runs") {
  SmallSimulator simulator(0.05);
  Options options;
  options.refined = 0;
  std::vector<Effect> effects = small_model().effects;
  effects[1].instrument = true;
  const LinearModel model = linearise(measured(16), effects, simulator, options);
  CHECK(simulator.runs == planned_runs(effects, 1, options));
  CHECK(model.runs == simulator.runs);
  CHECK(simulator.runs == 15 + 2 + 1 + 2);
  CHECK(model.sensitivities(30, 0) == doctest::Approx(3).epsilon(0.05));
  // Data ask for u = 2; sd 2 of the number against a prior of 3 per unit draws it back to about 1.4.
  CHECK(model.u[0] == doctest::Approx(2 * 9 / (9 + 4 * (1 + 0.2125))).epsilon(0.05));
  CHECK(model.base[30] == doctest::Approx(10 + 3 * model.u[0]).epsilon(0.01));
  CHECK((model.signatures[0] - small_signatures()[0]).norm() < 0.1 * small_signatures()[0].norm());
  CHECK((model.signatures[1] - small_signatures()[1]).norm() < 1e-12);
}

namespace {

/// As above, but for runs of one seed that scatter as differently as those of two.
class RoughSimulator : public SmallSimulator {
 public:
  RoughSimulator() : SmallSimulator(0) {}
  Matrix run(const std::vector<RunPoint>& points) override {
    Matrix out = SmallSimulator::run(points);
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      calx::Random random(points[static_cast<std::size_t>(k)].seed, made_++);
      out.col(k) += 2 * normal_vector(random, 31);
    }
    return out;
  }

 private:
  std::uint64_t made_ = 9;
};

}  // namespace

TEST_CASE("sixteen pairs of runs behind a sensitivity leave a quarter of the error of one, and count") {
  Options options;
  options.refined = 0, options.base_runs = {6};
  double squares[2] = {0, 0}, weights[2] = {0, 0};
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (int many = 0; many < 2; ++many) {
      RoughSimulator simulator;
      options.seed = seed, options.slope_runs = many == 0 ? 1 : 16;
      const LinearModel model = linearise(measured(10), {}, simulator, options);
      CHECK(simulator.runs == planned_runs({}, 1, options));
      squares[many] += std::pow(model.sensitivities(30, 0) - 3, 2), weights[many] += model.sensitivity_weight;
    }
  // A pair, a step of one to either side, leaves 2 / sqrt(2) = 1.4, drawn to nothing where the scatter hides it.
  CHECK(std::sqrt(squares[0] / 20) > 0.9);
  CHECK(std::sqrt(squares[1] / 20) < 0.55);
  CHECK(weights[1] < 0.2 * weights[0]);
}

TEST_CASE("data that ask for a far parameter do not take the base there") {
  SmallSimulator simulator(0.05);
  Options options;
  options.reach = 2.5;
  CHECK(linearise(measured(60), {}, simulator, options).u[0] == 2.5);
  CHECK(linearise(measured(-60), {}, simulator, options).u[0] == -2.5);
}

TEST_CASE("a response that is not proportional to the amplitude is corrected at the fitted amplitude") {
  SmallSimulator simulator(0.01);
  Options options;
  options.refined = 1;
  Observables all = measured(10);
  for (Vector* y : {&all.blocks[0].fit, &all.blocks[0].hold}) *y += 9 * small_signatures()[2].col(0).head(30);
  LinearModel model = linearise(all, small_model().effects, simulator, options);
  // Run at amplitude 2, the response is 4: signature 2 per unit, amplitude 4.5, where the response is 20 and not 9.
  CHECK(model.signatures[2](15, 0) == doctest::Approx(2).epsilon(0.05));
  const Bank bank = make_bank(all);
  refine(model, bank, simulator, options);
  CHECK(simulator.runs == planned_runs(small_model().effects, 1, options));
  CHECK(model.signatures[2](15, 0) > 3.5);
}

namespace {

/// Eight effects, each of a number of its own; runs of one seed share 0.8 of their variance.
class SharedSimulator : public Simulator {
 public:
  explicit SharedSimulator(std::uint64_t seed) : seed_(seed) {}
  int parameters() const override { return 1; }
  Matrix run(const std::vector<RunPoint>& points) override {
    Matrix out(31, static_cast<Eigen::Index>(points.size()));
    for (std::size_t k = 0; k < points.size(); ++k) {
      calx::Random common(seed_ + points[k].seed, 1), own(seed_ + points[k].seed, ++calls_ + 10);
      Vector y = std::sqrt(0.8) * normal_vector(common, 31) + std::sqrt(0.2) * normal_vector(own, 31);
      y = 0.5 * y;
      if (points[k].effect >= 0) y[points[k].effect] += points[k].amplitude[0];
      out.col(static_cast<Eigen::Index>(k)) = y;
    }
    return out;
  }
  Vector instrument(const RunPoint&) override { return Vector::Zero(31); }

 private:
  std::uint64_t seed_, calls_ = 0;
};

}  // namespace

TEST_CASE("what all runs of a seed share is taken out of a response, and its noise is as stated") {
  Options options;
  options.common_numbers = 0.8;
  double square = 0, stated = 0;
  int count = 0;
  for (std::uint64_t study = 0; study < 40; ++study) {
    SharedSimulator simulator(1000000 * study);
    const LinearModel model = linearise(measured(0), std::vector<Effect>(8), simulator, options);
    const Matrix runs = simulator.run({{model.u, 0, Vector::Ones(1), options.seed * 1000}});
    // Rows that no effect touches. One run has a variance of 0.25.
    square += model.response(runs.col(0)).segment(8, 22).squaredNorm() / 0.25, count += 22;
    stated += model.response_variance() / 40;
  }
  // The run without effects alone would foretell all but 1 - 0.8^2 = 0.36 and a little of the base mean's.
  CHECK(stated < 0.26);
  // 880 numbers: a variance known to sqrt(2 / 880); three times that.
  CHECK(square / count == doctest::Approx(stated).epsilon(3 * std::sqrt(2.0 / count)));
}

namespace {

/// A vector whose first direction moves a number of its own, while runs along the second one scatter by 30 sd.
class WildSimulator : public SharedSimulator {
 public:
  using SharedSimulator::SharedSimulator;
  Matrix run(const std::vector<RunPoint>& points) override {
    Matrix out = SharedSimulator::run(points);
    for (std::size_t k = 0; k < points.size(); ++k)
      if (points[k].effect >= 0 && points[k].amplitude[1] != 0) {
        calx::Random wild(points[k].seed, 7);
        out.col(static_cast<Eigen::Index>(k)) += 15 * normal_vector(wild, 31);
      }
    return out;
  }
};

}  // namespace

TEST_CASE("a direction in which the runs of a vector contradict each other is left out, the other one kept") {
  Options options;
  options.effect_runs = 3, options.step_scales = 40;
  WildSimulator simulator(5);
  std::vector<Effect> effects(1);
  effects[0].components = 2;
  const LinearModel model = linearise(measured(0), effects, simulator, options);
  CHECK(model.signatures[0](0, 0) == doctest::Approx(1).epsilon(0.1));
  CHECK(model.signatures[0].col(1).isZero(0));
}
