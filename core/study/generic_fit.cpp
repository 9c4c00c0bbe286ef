#include "study/generic_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/units.hpp"
#include "infer/denoise.hpp"
#include "infer/unknown_term.hpp"
#include "study/confirm.hpp"
#include "study/generic_terms.hpp"

namespace calx {
namespace {

using infer::Matrix;
using infer::Vector;

class GenericTrial {
 public:
  GenericTrial(const Study& study, StudyDiagnosis& d, StudySimulator& simulator, const DiagnosisPlan& plan)
      : study_(study), d_(d), simulator_(simulator), plan_(plan) {}

  GenericFit go() {
    GenericFit out;
    const std::vector<std::size_t> terms = add_candidates();
    if (terms.empty()) return out;
    // The same diagnosis with the terms as its library.
    StudyDiagnosis own = d_;
    own.kept.clear(), own.model.effects.clear(), own.model.signatures.clear(), own.model.signature_variance.clear();
    const std::vector<std::size_t> library = simulator_.effects;
    simulator_.effects = terms;
    simulator_.stage_of_effects = "signatures of the generic terms";
    add_signatures(own, terms);
    simulator_.effects = own.kept;
    if (!own.kept.empty()) {
      choose(own, out);
      if (out.reason.empty()) confirm(own, out);
    } else {
      out.reason = "no generic term could be run, or none leaves a trace";
    }
    simulator_.effects = library;
    return out;
  }

 private:
  std::vector<std::size_t> add_candidates() {
    const Library found = find_generic_terms(study_, d_.options.step_scales);
    std::vector<std::size_t> out;
    for (const Candidate& c : found.candidates) {
      out.push_back(d_.library.candidates.size());
      d_.library.candidates.push_back(c);
    }
    d_.library.untested.insert(d_.library.untested.end(), found.untested.begin(), found.untested.end());
    return out;
  }

  /// Runs at the place of the model with the seeds of its last base runs, which are their partners.
  void add_signatures(StudyDiagnosis& own, const std::vector<std::size_t>& terms) {
    const infer::LinearModel& m = d_.model;
    const auto seeds = std::min<Eigen::Index>(static_cast<Eigen::Index>(generic_seeds), m.base_columns.cols());
    std::vector<infer::RunPoint> points;
    for (std::size_t e = 0; e < terms.size(); ++e)
      for (Eigen::Index s = 0; s < seeds; ++s)
        points.push_back({m.u, static_cast<int>(e),
                          Vector::Constant(1, d_.options.step_scales * d_.library.candidates[terms[e]].effect.scale),
                          m.base_seed + static_cast<std::uint64_t>(s)});
    const Matrix runs = simulator_.run(points);
    const infer::Denoiser denoise(m.observables, m.scatter);
    for (std::size_t e = 0; e < terms.size(); ++e) {
      const Candidate& c = d_.library.candidates[terms[e]];
      Vector sum = Vector::Zero(m.base.size());
      int made = 0;
      for (Eigen::Index s = 0; s < seeds; ++s) {
        const Vector run = runs.col(static_cast<Eigen::Index>(e) * seeds + s);
        if (run.allFinite()) sum += m.response(run, m.base_columns.col(s)), ++made;
      }
      const auto failed = simulator_.failures().find(terms[e]);
      const Vector response = made > 0 ? denoise(sum / made, m.response_variance(made)) : sum;
      if (response.isZero(0)) {
        d_.library.untested.push_back({c.effect.id, failed == simulator_.failures().end()
                                                        ? "leaves no trace in what was measured"
                                                        : "its run failed: " + failed->second});
        continue;
      }
      const double amplitude = d_.options.step_scales * c.effect.scale;
      own.kept.push_back(terms[e]);
      own.model.effects.push_back(c.effect);
      own.model.signatures.push_back(response / amplitude);
      own.model.signature_variance.push_back(m.response_variance(made) / (amplitude * amplitude));
    }
    own.library = d_.library;
  }

  /// The likeliest for the fitted campaign alone, so that the held-out one stays a test.
  void choose(StudyDiagnosis& own, GenericFit& out) const {
    infer::Options singles = d_.options;
    singles.pairs = singles.unknown_rival = false;
    const infer::Budget& budget = d_.diagnosis.budget;
    const infer::Posed posed = infer::pose(own.model, budget.systematic, budget.fit, d_.options);
    own.diagnosis.posterior =
        infer::weigh(own.model, own.bank, infer::Metric(posed.covariance, posed.residual), singles);
    const std::vector<infer::SingleFit>& fits = own.diagnosis.posterior.fits;
    for (std::size_t e = 0; e < fits.size(); ++e) out.tried.push_back({own.kept[e], fits[e].odds});
    std::stable_sort(out.tried.begin(), out.tried.end(),
                     [](const GenericFit::Trial& a, const GenericFit::Trial& b) { return a.log_odds > b.log_odds; });
    const std::size_t best = index_of(own, out);
    const infer::SingleFit& fit = fits[best];
    out.amplitude = fit.amplitude, out.amplitude_sd = fit.sd;
    infer::Budget less = budget;
    less.fit = budget.both;
    less.fit.y -= own.model.signatures[best] * fit.amplitude;
    out.u = infer::fit_nuisance(own.model, less, d_.options).u;
    own.diagnosis.gain = infer::held_out_gain(own.model, budget, {{best, fit.amplitude, fit.shape_factor}}, d_.options);
    out.gain = own.diagnosis.gain.log_score;
    // What is left with it must be what chance leaves, as for a name.
    const infer::Posed all = infer::pose(own.model, budget.systematic, budget.both, d_.options);
    const infer::Freedom freedom = infer::freedom_of(own.model, {{best, fit.amplitude, fit.shape_factor}}, d_.options);
    const Matrix free = freedom.columns * freedom.columns.transpose() + freedom.own;
    own.diagnosis.after = infer::check_fit(own.model, own.bank, all.covariance - budget.both.noise + free,
                                           budget.both.noise, all.residual, d_.options, 2);
    out.fit_p = own.diagnosis.after.p;
    const double needed = infer::least_term_odds + std::log(static_cast<double>(fits.size()));
    if (out.tried[0].log_odds < needed)
      out.reason = "the likeliest of " + std::to_string(fits.size()) + " generic terms has log odds of " +
                   rounded(out.tried[0].log_odds) + "; " + rounded(needed) + " are needed";
    else if (out.fit_p < d_.options.fit_above)
      out.reason = "the likeliest of " + std::to_string(fits.size()) + " generic terms, " +
                   own.library.candidates[out.tried[0].candidate].info.id + ", does not fit the data";
    else if (out.gain < d_.options.gain_above)
      out.reason = "its gain on the held-out data, " + rounded(out.gain) + " nats, is in the noise; " +
                   rounded(d_.options.gain_above) + " are needed";
  }

  void confirm(StudyDiagnosis& own, GenericFit& out) {
    const std::size_t best = index_of(own, out);
    try {
      const auto fitted = [&](const char* stage, const RealModel& start) {
        d_.ledger.stage = stage;
        return plan_.steps > 0 ? fit_by_runs(own, simulator_, start, plan_.steps, plan_.step_seeds)
                               : RealFit{start, {}};
      };
      const RealFit old = fitted("old case fitted by runs", {d_.u_before, {}, {}});
      const RealFit extended = fitted("generic term fitted by runs", {out.u, {best}, {out.amplitude}});
      d_.ledger.stage = "confirmation of the generic term with new seeds";
      out.confirmation = confirm_by_runs(own, simulator_, old.model, extended.model, plan_.confirmed);
      out.u = extended.model.u, out.amplitude = extended.model.amplitudes[0];
      if (!extended.sd.empty()) out.amplitude_sd = std::max(out.amplitude_sd, extended.sd[0]);
    } catch (const Error& e) {
      if (e.fault() != Fault::numerics && e.fault() != Fault::settings) throw;
      out.reason = "the case with it could not be run: " + std::string(e.what());
      return;
    }
    if (!out.confirmation.passed)
      out.reason = "runs with new seeds do not show the improvement that was foretold";
    else if (!d_.library.candidates[out.tried[0].candidate].allows(out.amplitude))
      out.reason = "it would have to be stronger than its range allows";
    else
      out.accepted = true, out.reason = "predicts the held-out data, and runs with new seeds show it";
  }

  static std::string rounded(double nats) { return format_number(std::round(10 * nats) / 10); }
  static std::size_t index_of(const StudyDiagnosis& own, const GenericFit& fit) {
    return static_cast<std::size_t>(std::find(own.kept.begin(), own.kept.end(), fit.tried[0].candidate) -
                                    own.kept.begin());
  }

  const Study& study_;
  StudyDiagnosis& d_;
  StudySimulator& simulator_;
  const DiagnosisPlan& plan_;
};

}  // namespace

void prepare_generic_terms(Study& study, const std::string& folder) {
  const std::vector<GenericTerm> terms = read_generic_terms(study);
  if (terms.empty()) return;
  write_generic_plugins(folder + "/generic", terms);
  study.executor.plugin_path.push_back(folder + "/generic");
}

GenericFit fit_generic_term(const Study& study, StudyDiagnosis& d, StudySimulator& simulator,
                            const DiagnosisPlan& plan) {
  return GenericTrial(study, d, simulator, plan).go();
}

}  // namespace calx
