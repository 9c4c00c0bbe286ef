#include "diagnosis/blind_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/common_practice.hpp"
#include "diagnosis/experiments.hpp"
#include "diagnosis/troubles.hpp"

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

/// Distance of a single effect to its best imitation by another one.
double separability(const Ruler& ruler, const Truth& truth, const Vector& without, const Forms& forms) {
  const std::vector<infer::Effect> library = effect_library();
  const Vector d = ruler(plant(truth.u, truth.amplitudes, {}, forms, 0) - without);
  double least = d.norm();
  for (std::size_t e = 0; e < library.size(); ++e) {
    if (e == truth.effects[0]) continue;
    Matrix g(without.size(), library[e].components);
    for (int k = 0; k < library[e].components; ++k) {
      std::vector<Vector> amplitudes(effect_count);
      amplitudes[e] = 0.5 * library[e].scale * Vector::Unit(library[e].components, k);
      g.col(k) = ruler(simulate(truth.u, amplitudes) - simulate(truth.u, {}));
    }
    const Vector q = g.colPivHouseholderQr().solve(d);
    if (library[e].one_sided && q[0] < 0) continue;
    least = std::min(least, (d - g * q).norm());
  }
  return least;
}

}  // namespace

const char* trouble_name(Trouble trouble) {
  constexpr std::array<const char*, static_cast<std::size_t>(Trouble::count)> names = {
      "none",     "few observables", "far powder",      "gross errors",
      "wrong sd", "weak effects",    "inert covariate", "like causes"};
  return names[static_cast<std::size_t>(trouble)];
}

Trouble trouble_of(std::uint64_t study) {
  return static_cast<Trouble>(1 + study / 8 % (static_cast<std::uint64_t>(Trouble::count) - 1));
}

Study make_study(std::uint64_t seed, Trouble trouble) {
  constexpr std::array<Kind, 8> mix = {Kind::control, Kind::single, Kind::outside, Kind::single,
                                       Kind::control, Kind::single, Kind::outside, Kind::pair};
  const std::vector<infer::Effect> library = effect_library();
  Random random(seed, 11);
  Vector powder_of_day(line::parameters);
  for (double& u : powder_of_day) u = 0.8 * random.normal();
  if (trouble == Trouble::far_powder) take_far(random, powder_of_day);
  Study study{trouble, {}, {}, {}, Forms(random)};
  const Forms& forms = study.forms;
  Truth& truth = study.truth;
  truth.kind = trouble == Trouble::like_causes ? Kind::single : mix[seed % mix.size()];
  truth.u = powder_of_day;
  truth.amplitudes.resize(effect_count);
  const Ruler ruler(truth.u);
  const Vector without = plant(truth.u, {}, {}, forms, 0);

  // The strength that gives the delta drawn, by bisection.
  const double weakest = trouble == Trouble::weak ? 0.5 : 3, strongest = trouble == Trouble::weak          ? 2
                                                                         : trouble == Trouble::like_causes ? 10
                                                                                                           : 15;
  const auto strength = [&](auto signal) {
    const double wanted = std::exp(random.uniform(std::log(weakest), std::log(strongest)));
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
  const auto lay_out = [&](std::size_t e) {
    truth.effects.clear();
    truth.amplitudes.assign(effect_count, {});
    plant_effect(e);
    if (truth.kind == Kind::single) truth.separability = separability(ruler, truth, without, forms);
  };
  if (truth.kind == Kind::single || truth.kind == Kind::pair) lay_out(random.bits() % effect_count);
  while (trouble == Trouble::like_causes && truth.separability > 3) lay_out(random.bits() % effect_count);
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
  study.observables = line_observables();
  const Vector fit = mean + plant_noise(random);
  const Vector hold = plant(truth.u, truth.amplitudes, truth.strange, forms, 1) + plant_noise(random);
  study.bias.resize(mean.size());
  for (std::size_t b = 0; b < study.observables.blocks.size(); ++b) {
    infer::Block& block = study.observables.blocks[b];
    const int first = study.observables.first(b), n = study.observables.size(b);
    block.fit = fit.segment(first, n), block.hold = hold.segment(first, n);
    study.bias.segment(first, n) = 0.3 * block.sd * random.normal();
    const double error = std::exp((trouble == Trouble::wrong_sd ? 0.5 : 0.15) * random.normal());
    truth.noise_error.push_back(1 / error);
    block.sd *= error;
    block.autocorrelation *= random.uniform(0.6, 1.2);
  }
  if (trouble == Trouble::gross_errors) add_gross_errors(random, study.observables);
  return study;
}

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

Outcome diagnose_study(std::uint64_t seed, const infer::Options& given, Broken broken, double scatter,
                       Trouble trouble) {
  Study study = make_study(seed, trouble);
  Outcome outcome;
  outcome.trouble = trouble;
  outcome.truth = study.truth;
  infer::Options options = given;
  options.seed = seed;
  options.recalibrate = broken != Broken::no_recalibration;
  options.seed_scatter = broken != Broken::no_seed_scatter;
  options.unknown_rival = broken != Broken::no_unknown;
  if (broken == Broken::fit_is_hold_out)
    for (infer::Block& block : study.observables.blocks) block.hold = block.fit;
  LineSimulator line_simulator(0.8, seed * 2 + 1000003, study.bias, scatter);
  common_practice(study, line_simulator, outcome);
  const int runs_before = line_simulator.runs();
  TroubledSimulator simulator(line_simulator, trouble, study.observables);
  infer::LinearModel model = infer::linearise(study.observables, simulator.library(), simulator, options);
  const infer::Bank bank = infer::make_bank(model.observables, model.base);
  infer::refine(model, bank, simulator, options);
  outcome.runs = line_simulator.runs() - runs_before;
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
  if (options.unknown_rival) {
    const infer::Term& term = bank.terms[outcome.diagnosis.posterior.discrepancy.term];
    outcome.rival = term.family + " in " + model.observables.blocks[term.block].name;
  }
  if (outcome.diagnosis.verdict == infer::Verdict::unknown) {
    const std::vector<infer::UnknownTerm> terms = infer::find_terms(model, bank, outcome.diagnosis, options);
    if (!terms.empty()) outcome.family = bank.terms[terms[0].term].family, outcome.stability = terms[0].stability;
  }
  const bool whole = trouble != Trouble::few_observables && trouble != Trouble::inert_covariate;
  if (study.truth.kind == Kind::single && outcome.diagnosis.verdict == infer::Verdict::ambiguous &&
      study.truth.delta <= 10 && whole)
    ask_next(study, model, options, outcome);
  return outcome;
}

}  // namespace calx::diagnosis
