#include "diagnosis/blind_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/experiments.hpp"

namespace calx::diagnosis {

namespace {

/// Metric of the fitted campaign, as the generator states difficulty: nominal noise, scatter of six runs, tolerance,
/// recalibration free.
class Ruler {
 public:
  explicit Ruler(const Vector& u) {
    const infer::Observables all = line_observables();
    Matrix c = Matrix::Zero(all.rows(), all.rows());
    for (std::size_t b = 0; b < all.blocks.size(); ++b) {
      const int first = all.first(b), n = all.size(b);
      const Vector& sd = all.blocks[b].sd;
      const Matrix tolerance =
          n > 1 ? Matrix(0.5 * Matrix::Identity(n, n) + 0.5 * infer::smooth_kernel(all.blocks[b], 0.25))
                : Matrix::Ones(1, 1);
      c.block(first, first, n, n) =
          sd.asDiagonal() *
          (infer::autocorrelation_matrix(n, all.blocks[b].autocorrelation) + 0.35 * 0.35 * tolerance +
           0.49 / 6 * Matrix::Identity(n, n) + 0.25 / 6 * Matrix::Ones(n, n)) *
          sd.asDiagonal();
    }
    Matrix j(all.rows(), line::parameters);
    for (int k = 0; k < line::parameters; ++k)
      j.col(k) =
          (simulate(u + Vector::Unit(line::parameters, k), {}) - simulate(u - Vector::Unit(line::parameters, k), {})) /
          2;
    factor_.compute(c + j * j.transpose());
  }
  Vector operator()(const Vector& v) const { return factor_.matrixL().solve(v); }

 private:
  Eigen::LLT<Matrix> factor_;
};

Vector amplitude_of(const infer::Effect& effect, double strength, double sign, double turn) {
  if (effect.components == 1) return Vector::Constant(1, strength * effect.scale * sign);
  return strength * effect.scale * (Vector(2) << std::cos(turn), std::sin(turn)).finished();
}

}  // namespace

Study make_study(std::uint64_t seed) {
  constexpr std::array<Kind, 8> mix = {Kind::control, Kind::single, Kind::outside, Kind::single,
                                       Kind::control, Kind::single, Kind::outside, Kind::pair};
  const std::vector<infer::Effect> library = effect_library();
  Random random(seed, 11);
  Vector powder_of_day(line::parameters);
  for (double& u : powder_of_day) u = 0.8 * random.normal();
  Study study{{}, {}, {}, Forms(random)};
  const Forms& forms = study.forms;
  Truth& truth = study.truth;
  truth.kind = mix[seed % mix.size()];
  truth.u = powder_of_day;
  truth.amplitudes.resize(effect_count);
  const Ruler ruler(truth.u);
  const Vector without = plant(truth.u, {}, {}, forms, 0);

  // The strength that gives the delta drawn, by bisection.
  const auto strength = [&](auto signal) {
    const double wanted = std::exp(random.uniform(std::log(3), std::log(15)));
    double low = 1e-3, high = 20;
    for (int k = 0; k < 15; ++k) {
      const double middle = std::sqrt(low * high);
      (ruler(signal(middle) - without).norm() < wanted ? low : high) = middle;
    }
    return low;
  };
  const auto plant_effect = [&](std::size_t e) {
    const double sign = library[e].one_sided || random.uniform() < 0.5 ? 1 : -1, turn = random.uniform(0, 2 * line::pi);
    const double s = strength([&](double q) {
      std::vector<Vector> amplitudes(effect_count);
      amplitudes[e] = amplitude_of(library[e], q, sign, turn);
      return plant(truth.u, amplitudes, {}, forms, 0);
    });
    truth.effects.push_back(e);
    truth.amplitudes[e] = amplitude_of(library[e], s, sign, turn);
  };
  if (truth.kind == Kind::single || truth.kind == Kind::pair) plant_effect(random.bits() % effect_count);
  if (truth.kind == Kind::pair) {
    std::size_t other = truth.effects[0];
    while (other == truth.effects[0]) other = random.bits() % effect_count;
    plant_effect(other);
    std::sort(truth.effects.begin(), truth.effects.end());
  }
  if (truth.kind == Kind::outside) {
    truth.alien = static_cast<Alien>(random.bits() % alien_count);
    const bool signed_effect = truth.alien == cycle_step || truth.alien == sawtooth || truth.alien == slump ||
                               truth.alien == apex_shift || truth.alien == start_up;
    const double sign = signed_effect && random.uniform() < 0.5 ? -1 : 1;
    const auto strange = [&](double q) {
      std::vector<double> all(alien_count, 0.0);
      all[truth.alien] = sign * q * alien_scale(truth.alien);
      return all;
    };
    truth.strange = strange(strength([&](double q) { return plant(truth.u, {}, strange(q), forms, 0); }));
  }

  const Vector mean = plant(truth.u, truth.amplitudes, truth.strange, forms, 0);
  if (truth.kind != Kind::control) truth.delta = ruler(mean - without).norm();
  if (truth.kind == Kind::single) {
    truth.separability = truth.delta;
    const Vector d = ruler(mean - without);
    for (std::size_t e = 0; e < library.size(); ++e) {
      if (e == truth.effects[0]) continue;
      Matrix g(mean.size(), library[e].components);
      for (int k = 0; k < library[e].components; ++k) {
        std::vector<Vector> amplitudes(effect_count);
        amplitudes[e] = 0.5 * library[e].scale * Vector::Unit(library[e].components, k);
        g.col(k) = ruler(simulate(truth.u, amplitudes) - simulate(truth.u, {}));
      }
      const Vector q = g.colPivHouseholderQr().solve(d);
      if (library[e].one_sided && q[0] < 0) continue;
      truth.separability = std::min(truth.separability, (d - g * q).norm());
    }
  }

  study.observables = line_observables();
  const Vector fit = mean + plant_noise(random);
  const Vector hold = plant(truth.u, truth.amplitudes, truth.strange, forms, 1) + plant_noise(random);
  study.bias.resize(mean.size());
  for (std::size_t b = 0; b < study.observables.blocks.size(); ++b) {
    infer::Block& block = study.observables.blocks[b];
    const int first = study.observables.first(b), n = study.observables.size(b);
    block.fit = fit.segment(first, n), block.hold = hold.segment(first, n);
    study.bias.segment(first, n) = 0.3 * block.sd * random.normal();
    const double error = std::exp(0.15 * random.normal());
    truth.noise_error.push_back(1 / error);
    block.sd *= error;
    block.autocorrelation *= random.uniform(0.6, 1.2);
  }
  return study;
}

namespace {

/// Nuisances from bench tests alone, then the effect that cuts the squared error of everything most.
void common_practice(const Study& study, LineSimulator& simulator, Outcome& outcome) {
  const infer::Observables& all = study.observables;
  const Vector sd = all.sd();
  Vector y(all.rows());
  for (std::size_t b = 0; b < all.blocks.size(); ++b) y.segment(all.first(b), all.size(b)) = all.blocks[b].fit;
  const Vector zero = Vector::Zero(line::parameters);
  Matrix j(all.rows(), line::parameters);
  for (int k = 0; k < line::parameters; ++k)
    j.col(k) = (simulate(Vector::Unit(line::parameters, k), {}) - simulate(-Vector::Unit(line::parameters, k), {})) / 2;
  Matrix normal = 0.01 * Matrix::Identity(line::parameters, line::parameters);
  Vector pull = zero;
  const Vector base = simulate(zero, {});
  for (BlockIndex b : {angle_drained, angle_static, density, compression, wall})
    for (int k = all.first(b); k < all.first(b) + all.size(b); ++k) {
      normal += j.row(k).transpose() * j.row(k) / (sd[k] * sd[k]);
      pull += j.row(k).transpose() * (y[k] - base[k]) / (sd[k] * sd[k]);
    }
  const Vector u = normal.ldlt().solve(pull);
  const Vector r = (y - simulator.run({{u, -1, {}, 77}}).col(0)).cwiseQuotient(sd);
  const std::vector<infer::Effect> library = effect_library();
  double best = 0.95 * r.squaredNorm();
  std::size_t cause = effect_count;
  for (std::size_t e = 0; e < library.size(); ++e) {
    Matrix g(r.size(), library[e].components);
    for (int k = 0; k < library[e].components; ++k) {
      std::vector<Vector> amplitudes(effect_count);
      amplitudes[e] = library[e].scale * Vector::Unit(library[e].components, k);
      g.col(k) = (simulate(u, amplitudes) - simulate(u, {})).cwiseQuotient(sd);
    }
    const Vector q = g.colPivHouseholderQr().solve(r);
    if (library[e].one_sided && q[0] < 0) continue;
    const double left = (r - g * q).squaredNorm();
    if (left < best) best = left, cause = e;
  }
  outcome.common_practice_named = cause != effect_count;
  outcome.common_practice_right = study.truth.effects == std::vector<std::size_t>{cause};
}

}  // namespace

namespace {

/// The measurement proposed, and a random one, made at the plant.
void ask_next(const Study& study, const infer::LinearModel& model, const infer::Options& options, Outcome& outcome) {
  const std::vector<infer::Experiment> experiments = experiments_of(model.u);
  const std::size_t best = infer::propose(model, outcome.diagnosis, experiments, options)[0].experiment;
  Random random(options.seed, 14);
  const std::size_t other = random.bits() % experiments.size();
  outcome.next.asked = true;
  for (bool proposed : {true, false}) {
    const std::size_t x = proposed ? best : other;
    const Vector y = perform(x, study.truth.u, study.truth.amplitudes, study.truth.strange, study.forms, random);
    const std::vector<double> p = infer::after_experiment(
        infer::forecast(model, outcome.diagnosis, experiments[x], options), y, model.effects.size());
    std::vector<std::size_t> named;
    for (std::size_t e = 0; e < p.size(); ++e)
      if (p[e] > options.name_above) named.push_back(e);
    const bool right = named == study.truth.effects, wrong = !right && !named.empty();
    (proposed ? outcome.next.best_right : outcome.next.random_right) = right;
    (proposed ? outcome.next.best_wrong : outcome.next.random_wrong) = wrong;
  }
}

}  // namespace

Outcome diagnose_study(std::uint64_t seed, const infer::Options& given, Broken broken, double scatter) {
  Study study = make_study(seed);
  Outcome outcome;
  outcome.truth = study.truth;
  infer::Options options = given;
  options.seed = seed;
  options.recalibrate = broken != Broken::no_recalibration;
  options.seed_scatter = broken != Broken::no_seed_scatter;
  options.unknown_rival = broken != Broken::no_unknown;
  if (broken == Broken::fit_is_hold_out)
    for (infer::Block& block : study.observables.blocks) block.hold = block.fit;
  LineSimulator simulator(0.8, seed * 2 + 1000003, study.bias, scatter);
  infer::LinearModel model = infer::linearise(study.observables, effect_library(), simulator, options);
  const infer::Bank bank = infer::make_bank(model.observables);
  infer::refine(model, bank, simulator, options);
  outcome.runs = simulator.runs();
  if (broken == Broken::shuffled_signatures) {
    Random random(seed, 12);
    for (std::size_t e = model.signatures.size() - 1; e > 0; --e) {
      const std::size_t other = random.bits() % (e + 1);
      // Strength goes with the place, so that only the pattern is wrong.
      if (model.signatures[e].cols() == model.signatures[other].cols()) {
        const double ratio = model.effects[e].scale / model.effects[other].scale;
        model.signatures[e].swap(model.signatures[other]);
        model.signatures[e] /= ratio, model.signatures[other] *= ratio;
      }
    }
  }
  outcome.diagnosis = infer::diagnose(model, bank, options);
  if (outcome.diagnosis.verdict == infer::Verdict::unknown) {
    const std::vector<infer::UnknownTerm> terms = infer::find_terms(model, bank, outcome.diagnosis, options);
    if (!terms.empty()) outcome.family = bank.terms[terms[0].term].family, outcome.stability = terms[0].stability;
  }
  if (study.truth.kind == Kind::single && outcome.diagnosis.verdict == infer::Verdict::ambiguous &&
      study.truth.delta <= 10)
    ask_next(study, model, options, outcome);
  common_practice(study, simulator, outcome);
  return outcome;
}

}  // namespace calx::diagnosis
