// Runs made again where they count: at another place of the parameters, with several seeds; runs that cannot be made;
// what the scatter of runs leaves in a signature.
#include <doctest/doctest.h>

#include <cmath>

#include "infer/diagnosis.hpp"
#include "infer/small_problem.hpp"

using namespace calx::infer;

namespace {

/// base 10 + u^2 everywhere, effect 0 as its signature, each run with its own scatter. Effect 2 cannot be run beyond
/// amplitude 1; the last number does not answer to any effect and repeats bit by bit.
class Curved : public Simulator {
 public:
  explicit Curved(double scatter) : scatter_(scatter) {}
  int parameters() const override { return 1; }
  double step(int) const override { return 0.5; }
  Matrix run(const std::vector<RunPoint>& points) override {
    Matrix out(31, static_cast<Eigen::Index>(points.size()));
    for (std::size_t k = 0; k < points.size(); ++k) {
      const RunPoint& p = points[k];
      calx::Random random(p.seed * 131 + static_cast<std::uint64_t>(p.effect + 1), 9);
      Vector y = scatter_ * normal_vector(random, 31);
      y.array() += 10 + p.u[0] * p.u[0];
      if (p.effect >= 0) y += small_signatures()[static_cast<std::size_t>(p.effect)] * p.amplitude;
      y[30] = 10 + p.u[0];
      if (p.effect == 2 && p.amplitude[0] > 1) y.setConstant(std::nan(""));
      out.col(static_cast<Eigen::Index>(k)) = y;
    }
    runs += out.cols();
    return out;
  }
  Vector instrument(const RunPoint&) override { return Vector::Zero(31); }
  Eigen::Index runs = 0;

 private:
  double scatter_;
};

Observables measured_at(double level) {
  Observables all = small_observables();
  for (Block& b : all.blocks) b.fit.setConstant(level), b.hold.setConstant(level);
  return all;
}

}  // namespace

TEST_CASE("re-basing moves the plane to where the runs are, and leaves what it knew with less weight") {
  Curved simulator(0.02);
  Options options;
  LinearModel model = linearise(measured_at(10), small_model().effects, simulator, options);
  const Eigen::Index before = simulator.runs;
  const double weight = model.base_weight;
  Vector u(1);
  u << 3;
  rebase(model, u, 6, simulator, options);
  CHECK(simulator.runs - before == 7);
  CHECK(model.u[0] == 3);
  // 10 + u^2 is 19 there; what was known near 0 foretold 10 and counts a tenth or less.
  CHECK(model.base[5] == doctest::Approx(19).epsilon(0.03));
  CHECK(model.partner[5] == doctest::Approx(19).epsilon(0.02));
  CHECK(model.base_weight < 1 / 5.9);
  CHECK(model.base_weight > 0.8 / (6 + 1 / weight));
}

TEST_CASE("more seeds leave less of the scatter in a signature") {
  const auto error = [](int seeds) {
    double sum = 0;
    for (std::uint64_t study = 1; study <= 12; ++study) {
      Curved simulator(1.0);
      Options options;
      options.seed = study;
      Observables all = measured_at(10);
      for (Vector* y : {&all.blocks[0].fit, &all.blocks[0].hold}) *y += 3 * small_signatures()[0].col(0).head(30);
      LinearModel model = linearise(all, small_model().effects, simulator, options);
      options.refined = 1, options.refined_runs = seeds;
      refine(model, make_bank(all), simulator, options);
      sum += (model.signatures[0] - small_signatures()[0]).topRows(30).squaredNorm();
    }
    return sum;
  };
  CHECK(error(9) < 0.6 * error(1));
}

TEST_CASE("several seeds behind every signature, in the planned number of runs") {
  const auto error = [](int seeds, Eigen::Index* runs) {
    double sum = 0;
    for (std::uint64_t study = 1; study <= 12; ++study) {
      Curved simulator(1.0);
      Options options;
      options.seed = study, options.effect_runs = seeds, options.common_numbers = 0, options.refined = 0;
      const LinearModel model = linearise(measured_at(10), small_model().effects, simulator, options);
      sum += (model.signatures[0] - small_signatures()[0]).topRows(30).squaredNorm();
      *runs = simulator.runs;
      CHECK(simulator.runs == planned_runs(small_model().effects, 1, options));
    }
    return sum;
  };
  Eigen::Index few = 0, many = 0;
  const double once = error(1, &few);
  CHECK(error(6, &many) < 0.5 * once);
  CHECK(many == few + 5 * 3);
}

TEST_CASE("numbers that an effect cannot reach have no signature there, and an effect that cannot be run has none") {
  Curved simulator(0.3);
  Options options;
  const LinearModel model = linearise(measured_at(10), small_model().effects, simulator, options);
  CHECK(model.signatures[0](30, 0) == 0);
  CHECK(model.signatures[0].norm() > 0);
  // Its trial amplitude is 2 scales.
  CHECK(model.signatures[2].isZero(0));
}

TEST_CASE("one seed that cannot be run leaves the others to speak") {
  /// Fails for effect 0 at the seed that effects share.
  class Brittle : public Curved {
   public:
    using Curved::Curved;
    Matrix run(const std::vector<RunPoint>& points) override {
      Matrix out = Curved::run(points);
      for (std::size_t k = 0; k < points.size(); ++k)
        if (points[k].effect == 0 && points[k].seed == 1000)
          out.col(static_cast<Eigen::Index>(k)).setConstant(std::nan(""));
      return out;
    }
  } simulator(0.05);
  Options options;
  options.effect_runs = 4;
  const LinearModel model = linearise(measured_at(10), small_model().effects, simulator, options);
  CHECK((model.signatures[0] - small_signatures()[0]).topRows(30).norm() < 0.1 * small_signatures()[0].norm());
}

TEST_CASE("what scatter leaves in a signature widens the tolerance of its effect, and is none for an instrument") {
  Curved simulator(0.5);
  Options options;
  std::vector<Effect> effects = small_model().effects;
  effects[1].instrument = true;
  const LinearModel model = linearise(measured_at(10), effects, simulator, options);
  CHECK(noise_columns(model, 0, options).cols() == 0);
  options.signature_noise = true;
  const Matrix noise = noise_columns(model, 0, options);
  REQUIRE(noise.cols() > 0);
  CHECK(noise.row(30).isZero(0));
  // Not more than the scatter of the response itself, at the amplitude it was run at.
  const double sd = std::sqrt(model.response_variance()) * 0.5 / (2 * effects[0].scale);
  CHECK(noise.row(10).norm() < 1.1 * sd);
  CHECK(noise.row(10).norm() > 0.05 * sd);
  CHECK(noise_columns(model, 1, options).cols() == 0);
}
