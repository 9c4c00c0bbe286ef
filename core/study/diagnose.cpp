// diagnose.cpp: the order of a diagnosis: plan, runs, linear model, verdict, self-test, confirmation, what to measure
// next. The mathematics is in infer/.
#include "study/diagnose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/units.hpp"
#include "config/document.hpp"
#include "config/node.hpp"
#include "study/confirm.hpp"
#include "study/next_measurements.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

/// Runs of a plan: seeds of the base in each pass, effects run again at their fitted strength, rounds where base and
/// leading effects are run again where the leading one puts the parameters, seeds of base and effects in each, rounds
/// and seeds of the fit by runs of old and extended case, seeds of each side of the confirmation.
struct Plan {
  std::vector<int> base;
  int refined, rounds, rebased, leading, steps, step_seeds;
  std::size_t confirmed;
};
const std::array<Plan, 6> plans = {{{{6, 6, 10}, 6, 3, 8, 6, 5, 5, 8},
                                    {{4, 4, 6}, 4, 3, 6, 4, 4, 4, 6},
                                    {{3, 3, 4}, 3, 2, 4, 3, 3, 3, 4},
                                    {{3, 2, 3}, 2, 2, 3, 2, 2, 2, 3},
                                    {{2, 2, 2}, 1, 1, 3, 1, 1, 2, 2},
                                    {{2, 2}, 0, 0, 0, 0, 0, 2, 2}}};
constexpr int leaders = 2;
/// Runs of each full case that carry what the reduced ones say.
constexpr std::size_t full_runs = 4;

/// Data sets of the self-test per cause and strength, and strengths in scales of the cause.
constexpr int self_test_studies = 24;
const std::vector<double> self_test_strengths = {0.5, 1, 2, 4};
constexpr std::size_t self_test_causes = 3;

std::size_t used_cases(const Study& study, const std::vector<StudyObservable>& readings, bool reduced_only) {
  return static_cast<std::size_t>(std::count_if(study.cases.begin(), study.cases.end(), [&](const StudyCase& c) {
    return (!reduced_only || !c.reduced.empty()) &&
           std::any_of(readings.begin(), readings.end(),
                       [&](const StudyObservable& o) { return o.case_name == c.name; });
  }));
}

std::size_t runs_of(const Study& study, const Library& library, const Plan& plan) {
  const std::size_t cases = used_cases(study, study.observables, false);
  std::size_t runs = cases;  // the partner of the runs with effects
  for (const int n : plan.base) runs += static_cast<std::size_t>(n) * cases;
  bool some_leave_a_case = false;
  for (const StudyParameter& p : study.parameters) {
    const std::size_t reached = std::min(p.cases.size(), cases);
    runs += 2 * reached;
    some_leave_a_case = some_leave_a_case || reached < cases;
  }
  if (some_leave_a_case) runs += cases;
  std::size_t most = 0;
  for (const Candidate& c : library.candidates) {
    if (c.info.is_instrument) continue;
    const auto reached = static_cast<std::size_t>(std::count(c.cases.begin(), c.cases.end(), true));
    runs += static_cast<std::size_t>(c.effect.components) * reached;
    most = std::max(most, reached);
  }
  runs += static_cast<std::size_t>(plan.refined + plan.rounds * leaders * plan.leading) * most;
  if (plan.rounds > 0) runs += static_cast<std::size_t>(plan.rounds * (1 + plan.rebased)) * cases;
  runs += 2 * (static_cast<std::size_t>((1 + plan.steps) * plan.step_seeds) + plan.confirmed) * cases;
  return runs + full_runs * used_cases(study, study.observables, true);
}

/// The richest plan that the budget pays for. Where none does, candidates that the study did not name leave the
/// library, those that are declared to touch the least of what was measured first.
Plan plan_of(const Study& study, Library& library, std::size_t* planned) {
  for (const Plan& plan : plans) {
    *planned = runs_of(study, library, plan);
    if (*planned <= study.budget) return plan;
  }
  while (*planned > study.budget) {
    std::size_t least = library.candidates.size();
    for (std::size_t c = 0; c < library.candidates.size(); ++c) {
      const Candidate& one = library.candidates[c];
      if (one.named || one.info.is_instrument) continue;
      if (least == library.candidates.size() || one.touched < library.candidates[least].touched) least = c;
    }
    if (least == library.candidates.size()) break;
    library.untested.push_back({library.candidates[least].effect.id, "the budget of runs does not pay for it"});
    library.candidates.erase(library.candidates.begin() + static_cast<std::ptrdiff_t>(least));
    *planned = runs_of(study, library, plans.back());
  }
  if (*planned <= study.budget) return plans.back();
  throw Error(Fault::settings, study.file + " /budget/runs: " + std::to_string(study.budget) +
                                   " runs are too few; the cases with " + std::to_string(study.parameters.size()) +
                                   " parameters need " + std::to_string(*planned) + " at least. Give --budget " +
                                   std::to_string(*planned) + " or more");
}

class Diagnoser {
 public:
  Diagnoser(const Study& study, Executor& executor, const ProgressSink& sink)
      : study_(study), executor_(executor), sink_(sink) {}

  StudyDiagnosis go() {
    d_.measured = measured_blocks(study_);
    const std::vector<PossibleMeasurement> possible = read_experiments(study_);
    say("looking for effects that fit the cases of the study");
    d_.library = find_library(study_, d_.options.step_scales);
    plan_ = plan_of(study_, d_.library, &d_.ledger.planned);
    d_.options.seed = study_.seed;
    d_.options.signature_noise = true;
    d_.options.base_runs = plan_.base;
    d_.options.refined = plan_.refined;
    read_claims();
    say("plan: at most " + std::to_string(d_.ledger.planned) + " runs of " + std::to_string(study_.budget) + ", " +
        std::to_string(d_.library.candidates.size()) + " candidate causes, " +
        std::to_string(study_.parameters.size()) + " parameters, " + std::to_string(d_.measured.observables.rows()) +
        " measured numbers");
    StudySimulator simulator(study_, d_.measured.readings, d_.library, executor_, sink_, d_.ledger);
    simulator_ = &simulator;
    learn();
    judge();
    if (d_.diagnosis.verdict == infer::Verdict::named) check_ranges();
    if (d_.diagnosis.verdict == infer::Verdict::named) confirm();
    if (d_.diagnosis.verdict == infer::Verdict::unknown)
      d_.terms = infer::find_terms(d_.model, d_.bank, d_.diagnosis, d_.options);
    compare();
    judge_claims();
    if (d_.diagnosis.verdict != infer::Verdict::named && !possible.empty())
      d_.next = weigh_measurements(study_, possible, d_, executor_, sink_);
    return std::move(d_);
  }

 private:
  void say(const std::string& text) const {
    if (sink_.message) sink_.message(text);
  }

  /// The runs, and the linear model made of them.
  void learn() {
    d_.ledger.stage = "full cases and those of the data";
    const std::uint64_t first = d_.options.seed * 1000 + 1;
    std::vector<std::uint64_t> seeds;
    for (std::uint64_t k = 0; k < full_runs; ++k) seeds.push_back(first + k);
    const Vector carried = simulator_->anchor(seeds, d_.measured.observables.sd());
    for (std::size_t b = 0; b < d_.measured.observables.blocks.size(); ++b) {
      infer::Block& block = d_.measured.observables.blocks[b];
      const double error = carried[d_.measured.observables.first(b)] / block.sd.mean();
      if (error > 0) block.tolerance = std::hypot(block.tolerance, error);
    }
    std::vector<infer::Effect> effects;
    for (const Candidate& c : d_.library.candidates) effects.push_back(c.effect);
    d_.model = infer::linearise(d_.measured.observables, effects, *simulator_, d_.options);
    keep_foreign_base();
    drop_silent();
    d_.bank = infer::make_bank(d_.model.observables, d_.model.base);
    infer::refine(d_.model, d_.bank, *simulator_, d_.options);
    refine_leaders();
    if (d_.measured.split_repeats)
      d_.notes.push_back(
          "the study holds no data out, so the later half of the repeats was; data at other conditions would prove "
          "more");
    if (!d_.measured.has_hold_out)
      d_.notes.push_back("no data are held out and no repeats can be: no cause can be named");
  }

  /// The leading effect puts the parameters elsewhere than the model without it: base and leading effects are run there
  /// again, with several seeds, for their signatures carry the verdict. Repeated until strength and parameters stay.
  void refine_leaders() {
    std::size_t last = d_.model.effects.size();
    Vector last_amplitude;
    for (int round = 0; round < plan_.rounds && !d_.model.effects.empty(); ++round) {
      const infer::Budget budget = infer::error_budget(d_.model, d_.options);
      const infer::Posterior posterior = single_causes(budget);
      std::size_t leader = 0;
      for (std::size_t e = 1; e < posterior.fits.size(); ++e)
        if (posterior.fits[e].odds > posterior.fits[leader].odds) leader = e;
      // Without a trace of an effect, all is where it belongs already.
      if (posterior.fits[leader].odds < 1) return;
      const Vector amplitude = posterior.fits[leader].amplitude;
      const Vector u = nuisances_with(budget, d_.model.signatures[leader] * amplitude);
      const bool settled = leader == last && (amplitude - last_amplitude).norm() < 0.1 * amplitude.norm() &&
                           (u - d_.model.u).norm() < 0.3;
      if (settled) return;
      last = leader, last_amplitude = amplitude;
      infer::rebase(d_.model, u, plan_.rebased, *simulator_, d_.options);
      keep_foreign_base();
      infer::Options more = d_.options;
      more.refined = leaders, more.refined_runs = plan_.leading;
      infer::refine(d_.model, d_.bank, *simulator_, more);
    }
  }

  /// What another program gave is the base at the prior; the cases only say how it changes from there.
  void keep_foreign_base() {
    infer::LinearModel& m = d_.model;
    for (std::size_t b = 0; b < m.observables.blocks.size(); ++b) {
      const std::vector<double>& simulated = d_.measured.readings[b].simulated;
      if (simulated.empty()) continue;
      const int first = m.observables.first(b), n = m.observables.size(b);
      m.base.segment(first, n) = vector_of(simulated) + m.sensitivities.middleRows(first, n) * m.u;
    }
  }

  infer::Posterior single_causes(const infer::Budget& budget) const {
    infer::Options singles = d_.options;
    singles.pairs = singles.unknown_rival = false;
    const Matrix covariance =
        budget.systematic + budget.both.noise + d_.model.sensitivities * d_.model.sensitivities.transpose();
    return infer::weigh(d_.model, d_.bank,
                        infer::Metric(covariance, budget.both.y - d_.model.base + d_.model.sensitivities * d_.model.u),
                        singles);
  }

  /// Nuisance parameters of all data less a change.
  Vector nuisances_with(infer::Budget budget, const Vector& change) const {
    budget.fit = budget.both;
    budget.fit.y -= change;
    return infer::fit_nuisance(d_.model, budget, d_.options).u;
  }

  /// Effects whose runs failed or changed nothing leave the model, so that they take no share of the probability.
  void drop_silent() {
    std::vector<infer::Effect> effects;
    std::vector<Matrix> signatures;
    std::vector<double> variances;
    for (std::size_t e = 0; e < d_.model.effects.size(); ++e) {
      const auto failed = simulator_->failures().find(e);
      std::string reason;
      if (failed != simulator_->failures().end())
        reason = "its run failed: " + failed->second;
      else if (d_.model.signatures[e].isZero(0))
        reason = "leaves no trace in what was measured";
      if (!reason.empty()) {
        d_.library.untested.push_back({d_.model.effects[e].id, reason});
        continue;
      }
      d_.kept.push_back(e);
      effects.push_back(d_.model.effects[e]);
      signatures.push_back(d_.model.signatures[e]);
      variances.push_back(d_.model.signature_variance[e]);
    }
    d_.model.effects = effects, d_.model.signatures = signatures, d_.model.signature_variance = variances;
    simulator_->effects = d_.kept;
  }

  void judge() {
    say("weighing " + std::to_string(d_.model.effects.size()) + " causes");
    d_.diagnosis = infer::diagnose(d_.model, d_.bank, d_.options);
    infer::Diagnosis& v = d_.diagnosis;
    if (!d_.measured.has_hold_out && v.verdict == infer::Verdict::ambiguous)
      v.reason = "no data are held out, and without them no cause is named";
    std::vector<std::size_t> order(d_.model.effects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return v.posterior.inclusion[a] > v.posterior.inclusion[b]; });
    order.resize(std::min(order.size(), self_test_causes));
    say("self-test on made-up data");
    d_.self_test = infer::self_test(d_.model, d_.bank, order, self_test_strengths, self_test_studies, d_.options);
    d_.options.calibration = d_.self_test.calibration;
    for (std::size_t e = 0; e < v.probability.size(); ++e)
      v.probability[e] = d_.options.calibration(v.posterior.inclusion[e]);

    std::vector<Vector> amplitudes;
    for (const infer::SingleFit& f : v.posterior.fits) amplitudes.push_back(f.amplitude);
    const infer::View& view = v.budget.both;
    const Matrix covariance =
        v.budget.systematic + view.noise + d_.model.sensitivities * d_.model.sensitivities.transpose();
    d_.confusion = infer::compare_causes(
        d_.model, infer::Metric(covariance, view.y - d_.model.base + d_.model.sensitivities * d_.model.u), amplitudes);
    find_amplitudes();
  }

  /// Strengths of what was named, and the nuisance parameters without and with it, from all data.
  void find_amplitudes() {
    const infer::Diagnosis& v = d_.diagnosis;
    d_.explained = v.named;
    for (std::size_t e = 0; e < v.posterior.inclusion.size() && v.named.empty(); ++e)
      if (v.posterior.inclusion[e] > 0.5 && d_.explained.size() < 2) d_.explained.push_back(e);
    d_.amplitudes.clear();
    for (const std::size_t e : d_.explained) d_.amplitudes.push_back(v.posterior.fits[e].amplitude);
    for (const infer::PairModel& pair : v.posterior.pairs)
      if (d_.explained.size() == 2 && pair.first == d_.explained[0] && pair.second == d_.explained[1])
        d_.amplitudes = {pair.fit.first, pair.fit.second};
    infer::Budget all = v.budget;
    all.fit = v.budget.both;
    const infer::NuisanceFit old = infer::fit_nuisance(d_.model, all, d_.options);
    d_.u_before = old.u;
    d_.u_sd.clear();
    for (Eigen::Index k = 0; k < old.u.size(); ++k) d_.u_sd.push_back(std::sqrt(old.covariance(k, k)));
    d_.u_after = nuisances_with(v.budget, explained_change());
  }

  Vector explained_change() const {
    Vector out = Vector::Zero(d_.model.base.size());
    for (std::size_t k = 0; k < d_.explained.size(); ++k)
      out += d_.model.signatures[d_.explained[k]] * d_.amplitudes[k];
    return out;
  }

  void compare() {
    const infer::LinearModel& m = d_.model;
    d_.before = m.base + m.sensitivities * (d_.u_before - m.u);
    d_.after = m.base + m.sensitivities * (d_.u_after - m.u) + explained_change();
    // Runs are better than what was foretold of them.
    if (d_.confirmation.done)
      d_.before = vector_of(d_.confirmation.before), d_.after = vector_of(d_.confirmation.after);
    if (!d_.explained.empty()) return;
    for (const infer::UnknownTerm& t : d_.terms) {
      d_.after += infer::columns_of(d_.bank.terms[t.term], m.observables) * t.coefficients;
    }
  }

  void check_ranges() {
    for (std::size_t k = 0; k < d_.explained.size(); ++k) {
      const Candidate& c = d_.library.candidates[d_.kept[d_.explained[k]]];
      if (!c.allows(d_.amplitudes[k]))
        return withdraw(c.info.id + " would have to be stronger than its range allows (" + c.parameter + " " +
                        format_number(c.lowest) + " to " + brief_quantity(c.highest, c.unit) + ")");
    }
  }

  /// The old and the extended case, fitted by runs and then run with new seeds against the held-out data.
  void confirm() {
    const RealModel old{d_.u_before, {}, {}}, named{d_.u_after, d_.explained, d_.amplitudes};
    try {
      d_.ledger.stage = "old case fitted by runs";
      const RealModel old_fit = fit_by_runs(d_, *simulator_, old, plan_.steps, plan_.step_seeds).model;
      d_.ledger.stage = "extended case fitted by runs";
      const RealFit fit = fit_by_runs(d_, *simulator_, named, plan_.steps, plan_.step_seeds);
      d_.ledger.stage = "confirmation with new seeds";
      d_.confirmation = confirm_by_runs(d_, *simulator_, old_fit, fit.model, plan_.confirmed);
      d_.u_before = old_fit.u, d_.u_after = fit.model.u;
      d_.amplitudes = fit.model.amplitudes;
      d_.amplitude_sd = fit.sd;
    } catch (const Error& e) {
      if (e.fault() != Fault::numerics && e.fault() != Fault::settings) throw;
      return withdraw("the extended case could not be run: " + std::string(e.what()));
    }
    if (!d_.confirmation.passed)
      withdraw("the extended case, run with new seeds, does not show the improvement that was foretold");
    else
      check_ranges();
  }

  void withdraw(const std::string& why) {
    d_.diagnosis.verdict = infer::Verdict::ambiguous;
    d_.diagnosis.reason = why;
    d_.diagnosis.named.clear();
  }

  void read_claims() {
    Document document(Parameters{study_.claims, "/claims", study_.folder}, study_.file);
    std::vector<std::string> observables;
    for (const StudyObservable& o : study_.observables) observables.push_back(o.name);
    for (const Node& node : Node(document, document.root(), "/claims").items("claimed causes")) {
      Object o(node, "a claimed cause");
      Claim c;
      c.effect = o.need("effect", "the id of an effect").text("the id of an effect");
      c.observable = o.need("observable", "what it is said to explain").name_of("observable", observables);
      c.says = o.text("says", "the claim in words");
      c.too_much =
          o.choice("simulation", "what the claim says of the simulation", {"lacks it", "has too much of it"}, 0) == 1;
      o.done();
      d_.claims.push_back(c);
    }
  }

  void judge_claims() {
    for (Claim& c : d_.claims) judge_claim(c);
  }

  void judge_claim(Claim& c) const {
    const infer::Observables& all = d_.model.observables;
    std::size_t b = 0;
    while (all.blocks[b].name != c.observable && b + 1 < all.blocks.size()) ++b;
    const infer::Block& block = all.blocks[b];
    const int first = all.first(b), n = all.size(b);
    const std::vector<double>& simulated = d_.measured.readings[b].simulated;
    const Vector& y = block.fit.size() != 0 ? block.fit : block.hold;
    const Vector from = simulated.empty() ? Vector(d_.before.segment(first, n)) : vector_of(simulated);
    c.departure = (y - from).mean();
    const infer::Budget& budget = d_.diagnosis.budget;
    const Matrix& noise = (block.fit.size() != 0 ? budget.fit : budget.hold).noise;
    c.departure_sd = std::sqrt((budget.systematic + noise).block(first, first, n, n).sum()) / n;
    c.verdict = "untested";
    for (std::size_t e = 0; e < d_.kept.size(); ++e) {
      const Candidate& candidate = d_.library.candidates[d_.kept[e]];
      if (candidate.info.id != c.effect) continue;
      c.change = candidate.effect.scale * d_.model.signatures[e].col(0).segment(first, n).mean();
      // Less of an effect is always possible where there is too much of it, more of a one-sided one where it lacks.
      const bool one_way = candidate.effect.one_sided || c.too_much;
      const double would = c.too_much ? -c.change : c.change;
      c.verdict = c.change == 0 ? "unresolved" : one_way && would * c.departure < 0 ? "contradicted" : "possible";
    }
    c.sentence = sentence_of(c, d_.measured.readings[b].unit);
  }

  static std::string sentence_of(const Claim& c, const std::string& unit) {
    const std::string error = "the simulation gives " + brief_quantity(std::fabs(c.departure), unit) +
                              (c.departure > 0 ? " too little" : " too much") + " (" +
                              format_number(std::round(10 * std::fabs(c.departure) / c.departure_sd) / 10) +
                              " standard errors)";
    const std::string of = c.effect + " for " + c.observable + ": " + error;
    if (c.verdict == "untested") return of + "; the effect could not be tried in this case";
    if (c.verdict == "unresolved") return of + "; the effect leaves no trace here that these runs resolve";
    const double would = c.too_much ? -c.change : c.change;
    const std::string remedy = c.too_much ? "less of the claimed cause would give " : "the claimed cause would give ";
    const std::string direction = would > 0 ? "more" : "less";
    if (c.verdict == "contradicted") return of + ", but " + remedy + direction + ": contradicted by its sign";
    return of + ", and " + remedy + direction + ": its sign fits, which proves nothing yet";
  }

  const Study& study_;
  Executor& executor_;
  const ProgressSink& sink_;
  StudySimulator* simulator_ = nullptr;
  Plan plan_;
  StudyDiagnosis d_;
};

}  // namespace

StudyDiagnosis diagnose_study(const Study& study, Executor& executor, const ProgressSink& sink) {
  return Diagnoser(study, executor, sink).go();
}

}  // namespace calx
