// diagnose.cpp: the order of a diagnosis: plan, runs, linear model, verdict, self-test, confirmation, what to measure
// next. The mathematics is in infer/.
#include "study/diagnose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/units.hpp"
#include "study/claims.hpp"
#include "study/confirm.hpp"
#include "study/diagnosis_plan.hpp"
#include "study/generic_fit.hpp"
#include "study/hints.hpp"
#include "study/next_measurements.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

/// Data sets of the self-test per cause and strength: many where runs are many, for they cost more than a few runs do.
int self_test_studies(std::size_t budget) { return static_cast<int>(std::clamp<std::size_t>(budget / 8, 8, 24)); }
/// In scales of the cause.
const std::vector<double> self_test_strengths = {0.5, 1, 2, 4};
constexpr std::size_t self_test_causes = 3;
constexpr int most_steps = 8;  // of the fit by runs of a cause that the fit test refuses
constexpr double reach = 2.5;  // prior sd of a parameter beyond which no base run is made
constexpr int most_looks = 2;  // beyond the first, where it leaves the verdict open

class Diagnoser {
 public:
  Diagnoser(const Study& study, Executor& executor, const ProgressSink& sink)
      : study_(study), executor_(executor), sink_(sink) {}

  StudyDiagnosis go() {
    d_.measured = measured_blocks(study_);
    const std::vector<PossibleMeasurement> possible = read_experiments(study_);
    say("looking for effects that fit the cases of the study");
    d_.library = find_library(study_, d_.options.step_scales);
    d_.claims = read_claims(study_, d_.library);
    plan_ = plan_of(study_, d_.library, &d_.ledger.planned);
    d_.options.seed = study_.seed;
    d_.options.signature_noise = true;
    d_.options.base_runs = plan_.base;
    d_.options.slope_runs = plan_.slopes;
    d_.options.reach = reach;
    d_.options.refined = plan_.refined;
    d_.options.effect_runs = plan_.trials;
    say("plan: at most " + std::to_string(d_.ledger.planned) + " runs of " + std::to_string(study_.budget) + ", " +
        std::to_string(d_.library.candidates.size()) + " candidate causes, " +
        std::to_string(study_.parameters.size()) + " parameters, " + std::to_string(d_.measured.observables.rows()) +
        " measured numbers");
    StudySimulator simulator(study_, d_.measured.readings, d_.library, executor_, sink_, d_.ledger);
    simulator_ = &simulator;
    learn();
    judge();
    if (d_.library.runs_for_all > 0)
      d_.notes.push_back("the budget leaves causes out; " + std::to_string(d_.library.runs_for_all) +
                         " runs would try all of them");
    if (!d_.diagnosis.refused.empty()) reconsider();
    if (d_.diagnosis.verdict == infer::Verdict::named) check_name();
    if (d_.diagnosis.verdict == infer::Verdict::named) confirm();
    if (d_.diagnosis.verdict == infer::Verdict::unknown) describe_unknown();
    compare();
    judge_claims(study_, d_);
    if (d_.diagnosis.verdict != infer::Verdict::named && !possible.empty())
      d_.next = weigh_measurements(study_, possible, d_, executor_, sink_);
    d_.hints = hints_of(study_, d_);
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
    look_again();
    if (d_.measured.split_repeats)
      d_.notes.push_back(
          "the study holds no data out, so the later half of the repeats was; data at other conditions would prove "
          "more");
    if (!d_.measured.has_hold_out)
      d_.notes.push_back("no data are held out and no repeats can be: no cause can be named");
  }

  /// The leading effect puts the parameters elsewhere than the model without it: base and leading effects are run there
  /// again, with several seeds, for their signatures carry the verdict. Repeated until strength and parameters stay, by
  /// the plan at first and then as long as the runs that are left pay for a confirmation, too.
  void refine_leaders() {
    std::size_t last = d_.model.effects.size();
    Vector last_amplitude;
    for (int round = 0; !d_.model.effects.empty(); ++round) {
      if (round >= plan_.rounds && (plan_.rounds == 0 || !pays_for(plan_.round_runs + plan_.confirmation_runs(1))))
        return;
      const infer::Budget budget = infer::error_budget(d_.model, d_.options);
      const infer::Posterior posterior = single_causes(budget);
      const std::size_t leader = leader_of(posterior);
      // Without a trace of an effect, all is where it belongs already.
      if (posterior.fits[leader].odds < 1) return;
      const Vector amplitude = posterior.fits[leader].amplitude;
      const Vector u = nuisances_with(budget, d_.model.signatures[leader] * amplitude);
      const bool settled = leader == last && (amplitude - last_amplitude).norm() < 0.1 * amplitude.norm() &&
                           (u - d_.model.u).norm() < 0.3;
      if (settled) return;
      last = leader, last_amplitude = amplitude;
      run_leaders(u, leaders);
    }
  }

  /// Where the first look names nothing although something is wrong, runs kept for the confirmation of a name go to
  /// more seeds of the causes that are left; a bare confirmation stays paid for.
  void look_again() {
    const std::size_t cost =
        plan_.round_runs + static_cast<std::size_t>((rivals - leaders) * plan_.leading) * plan_.cases;
    for (int look = 0; look < most_looks && plan_.rounds > 0 && !d_.model.effects.empty(); ++look) {
      if (!pays_for(cost + plan_.confirmation_runs(0))) return;
      const infer::Diagnosis now = infer::diagnose(d_.model, d_.bank, d_.options);
      // What the fit test refuses is fitted by runs instead.
      if (now.verdict == infer::Verdict::named || !now.refused.empty()) return;
      const infer::Budget budget = infer::error_budget(d_.model, d_.options);
      const infer::Posterior posterior = single_causes(budget);
      const std::size_t leader = leader_of(posterior);
      if (posterior.fits[leader].odds < 1) return;
      run_leaders(nuisances_with(budget, d_.model.signatures[leader] * posterior.fits[leader].amplitude), rivals);
    }
  }

  void run_leaders(const Vector& u, int count) {
    infer::rebase(d_.model, infer::within_reach(u, d_.options), plan_.rebased, *simulator_, d_.options);
    keep_foreign_base();
    infer::Options more = d_.options;
    more.refined = count, more.refined_runs = plan_.leading;
    infer::refine(d_.model, d_.bank, *simulator_, more);
  }

  static std::size_t leader_of(const infer::Posterior& posterior) {
    std::size_t leader = 0;
    for (std::size_t e = 1; e < posterior.fits.size(); ++e)
      if (posterior.fits[e].odds > posterior.fits[leader].odds) leader = e;
    return leader;
  }

  /// Rounds beyond the plan leave fewer steps of the fit by runs to do, and fewer runs to do them. reserve: runs that
  /// stay paid for beside the confirmation.
  void keep_to_plan(std::size_t reserve) {
    while (plan_.steps > 0 && !pays_for(plan_.confirmation_runs(plan_.steps) + reserve)) --plan_.steps;
  }

  /// Runs at one place of a fit.
  std::size_t place_runs() const { return static_cast<std::size_t>(plan_.step_seeds) * plan_.cases; }

  /// Steps of one fit by runs that leave a bare confirmation paid for; -1 where not even its first place is.
  int steps_paid(int most) const {
    while (most >= 0 && !pays_for(static_cast<std::size_t>(1 + most) * place_runs() + plan_.confirmation_runs(0)))
      --most;
    return most;
  }

  /// Beside the generic terms, which a verdict of "not in the library" runs instead.
  bool pays_for(std::size_t runs) const {
    return d_.ledger.runs.size() + runs + plan_.generic_runs <= d_.ledger.planned;
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
    const infer::Posed posed = infer::pose(d_.model, budget.systematic, budget.both, d_.options);
    return infer::weigh(d_.model, d_.bank, infer::Metric(posed.covariance, posed.residual), singles);
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
      if (d_.model.signatures[e].isZero(0)) {
        d_.library.untested.push_back({d_.model.effects[e].id, failed == simulator_->failures().end()
                                                                   ? "leaves no trace in what was measured"
                                                                   : "its run failed: " + failed->second});
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
    d_.self_test =
        infer::self_test(d_.model, d_.bank, order, self_test_strengths, self_test_studies(study_.budget), d_.options);
    d_.options.calibration = d_.self_test.calibration;
    infer::calibrate(v, d_.options);

    std::vector<Vector> amplitudes;
    for (const infer::SingleFit& f : v.posterior.fits) amplitudes.push_back(f.amplitude);
    const infer::Posed posed = infer::pose(d_.model, v.budget.systematic, v.budget.both, d_.options);
    d_.confusion = infer::compare_causes(d_.model, infer::Metric(posed.covariance, posed.residual), amplitudes);
    find_amplitudes();
  }

  /// Strengths of what was named, and the nuisance parameters without and with it, from all data.
  void find_amplitudes() {
    const infer::Diagnosis& v = d_.diagnosis;
    d_.explained = v.named.empty() ? v.refused : v.named;
    const bool open = d_.explained.empty();
    for (std::size_t e = 0; e < v.posterior.inclusion.size() && open; ++e)
      if (v.posterior.inclusion[e] > 0.5 && d_.explained.size() < 2) d_.explained.push_back(e);
    d_.amplitudes.clear();
    for (const infer::Part& part : infer::parts_of(v.posterior, d_.explained)) d_.amplitudes.push_back(part.amplitude);
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

  /// The fit test may have refused no more than the linear model of a strong effect: the extended case is fitted by
  /// runs, and the test asks again what those runs leave of the data.
  void reconsider() {
    infer::Diagnosis& v = d_.diagnosis;
    const int steps = steps_paid(most_steps);
    if (steps < 1 || v.gain.log_score < d_.options.gain_above) return;
    d_.ledger.stage = "extended case fitted by runs";
    RealFit fit;
    try {
      fit = fit_by_runs(d_, *simulator_, {d_.u_after, d_.explained, d_.amplitudes}, steps, plan_.step_seeds);
    } catch (const Error& e) {
      if (e.fault() != Fault::numerics && e.fault() != Fault::settings) throw;
      return;
    }
    const infer::FitCheck check = check_runs(d_, fit, static_cast<std::size_t>(plan_.step_seeds));
    if (check.p < d_.options.fit_above) return;
    v.after = check;
    v.named.swap(v.refused);
    v.verdict = infer::Verdict::named;
    v.reason = "probable, fits when it is run, and predicts the held-out data";
    d_.u_after = fit.model.u, d_.amplitudes = fit.model.amplitudes;
  }

  /// A strength out of range, or a cause that nobody tried and that may do the same, takes a name away.
  void check_name() {
    if (d_.library.runs_for_all > 0)
      return withdraw("the budget leaves other causes out, and one of them may do the same");
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
    // One of two may have to be fitted alone.
    keep_to_plan(d_.explained.size() > 1 ? place_runs() : 0);
    const auto fitted = [&](const char* stage, const RealModel& start) {
      d_.ledger.stage = stage;
      // A poor plan takes what the linear model says.
      return plan_.steps > 0 ? fit_by_runs(d_, *simulator_, start, plan_.steps, plan_.step_seeds) : RealFit{start, {}};
    };
    try {
      const RealModel old_fit = fitted("old case fitted by runs", old).model;
      RealFit fit = fitted("extended case fitted by runs", named);
      if (!keep_partner(fit)) return;
      d_.ledger.stage = "confirmation with new seeds";
      d_.confirmation = confirm_by_runs(d_, *simulator_, old_fit, fit.model, plan_.confirmed);
      d_.u_before = old_fit.u, d_.u_after = fit.model.u;
      d_.amplitudes = fit.model.amplitudes;
      d_.amplitude_sd = fit.sd;
    } catch (const Error& e) {
      if (e.fault() != Fault::numerics && e.fault() != Fault::settings) throw;
      return withdraw("the extended case could not be run: " + std::string(e.what()));
    }
    if (d_.confirmation.contradicted)
      withdraw(
          "the extended case, run with new seeds, lies farther from the data than was foretold, so that what chose it "
          "among the causes is in doubt");
    else if (!d_.confirmation.passed)
      withdraw("the extended case, run with new seeds, does not show the improvement that was foretold");
    else
      check_name();
  }

  /// Of two causes the weaker one has to earn its place when they are run, too: what makes up for the linear model of
  /// the other adds nothing to it. Without it the other has to fit alone. False where the name is withdrawn.
  bool keep_partner(RealFit& fit) {
    // A poor plan takes what the linear model says.
    if (d_.explained.size() != 2 || plan_.steps == 0) return true;
    infer::Diagnosis& v = d_.diagnosis;
    const auto gain_of = [&](std::size_t e) {
      return infer::held_out_gain(d_.model, v.budget, infer::parts_of(v.fitted, {e}), d_.options);
    };
    const infer::Gain gains[] = {gain_of(d_.explained[0]), gain_of(d_.explained[1])};
    const std::size_t weak = gains[0].log_score < gains[1].log_score ? 0 : 1, left = d_.explained[1 - weak];
    const RealModel start{fit.model.u, {left}, {fit.model.amplitudes[1 - weak]}};
    const RealFit alone = fit_by_runs(d_, *simulator_, start, steps_paid(plan_.steps), plan_.step_seeds);
    const auto seeds = static_cast<std::size_t>(plan_.step_seeds);
    if (held_out_score(d_, fit.figures, seeds) - held_out_score(d_, alone.figures, seeds) >= d_.options.partner_above)
      return true;
    d_.dropped = {d_.explained[weak]};
    d_.notes.push_back(d_.model.effects[d_.explained[weak]].id +
                       " was probable as a second cause, but adds nothing when it is run");
    d_.explained = v.named = {left};
    d_.amplitudes = alone.model.amplitudes, d_.u_after = alone.model.u;
    v.gain = gains[1 - weak];
    v.after = check_runs(d_, alone, seeds);
    fit = alone;
    if (v.after.p >= d_.options.fit_above) return true;
    withdraw("of two probable causes one adds nothing when it is run, and the other does not fit the data alone");
    return false;
  }

  /// What is not in the library, as a shape of the observables and, where the study asks for it, as a generic term.
  void describe_unknown() {
    d_.terms = infer::find_terms(d_.model, d_.bank, d_.diagnosis, d_.options);
    keep_to_plan(0);
    d_.generic = fit_generic_term(study_, d_, *simulator_, plan_);
  }

  void withdraw(const std::string& why) {
    d_.diagnosis.verdict = infer::Verdict::ambiguous;
    d_.diagnosis.reason = why;
    d_.diagnosis.named.clear();
  }

  const Study& study_;
  Executor& executor_;
  const ProgressSink& sink_;
  StudySimulator* simulator_ = nullptr;
  DiagnosisPlan plan_;
  StudyDiagnosis d_;
};

}  // namespace

StudyDiagnosis diagnose_study(const Study& study, Executor& executor, const ProgressSink& sink) {
  return Diagnoser(study, executor, sink).go();
}

}  // namespace calx
