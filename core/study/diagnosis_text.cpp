// diagnosis_text.cpp: a diagnosis in words and as JSON. Nothing here depends on how many jobs ran, on what was cached
// or on the order of effects in the study, so that a repeated or resumed study writes the same bytes.
#include "study/diagnosis_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/sha256.hpp"
#include "base/units.hpp"
#include "base/version.hpp"
#include "config/document.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using infer::Vector;
using infer::Verdict;

Json list(const Vector& v) { return std::vector<double>(v.data(), v.data() + v.size()); }

Json matrix(const infer::Matrix& m) {
  Json out = Json::array();
  for (Eigen::Index k = 0; k < m.rows(); ++k) out.push_back(list(m.row(k).transpose()));
  return out;
}

std::string percent(double share) { return format_number(std::round(1000 * share) / 10) + " %"; }

class DiagnosisText {
 public:
  DiagnosisText(const Study& study, const StudyDiagnosis& d)
      : study_(study), d_(d), v_(d.diagnosis), effects_(d.model.effects.size()) {
    for (std::size_t e = 0; e < effects_; ++e) order_.push_back(e);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return v_.probability[a] > v_.probability[b]; });
  }

  Json json(const std::vector<std::pair<std::string, std::string>>& extensions) const {
    Json j;
    j["calx_diagnosis"] = 1;
    j["title"] = study_.title;
    j["study"] = fs::path(study_.file).filename().string();
    j["data_sha256"] = data_hash();
    j["calx"] = std::string(version()) + " " + git_revision();
    j["seed"] = study_.seed;
    j["verdict"] = infer::name(v_.verdict);
    j["reason"] = v_.reason;
    j["sentence"] = sentence();
    j["causes"] = causes();
    j["evidence"] = {{"none", v_.posterior.none},
                     {"unknown", v_.posterior.unknown},
                     {"fit_p", v_.before.p},
                     {"fit_p_with_named", v_.after.p}};
    j["set"] = Json::array();
    for (const std::size_t k : v_.set)
      j["set"].push_back(k < effects_ ? d_.model.effects[k].id : k == effects_ ? "none" : "unknown");
    j["after_holds"] = Json::array();
    for (const std::size_t e : d_.explained) j["after_holds"].push_back(d_.model.effects[e].id);
    j["observables"] = observables();
    j["events"] = events();
    j["confusability"] = confusability();
    j["unknown_terms"] = terms();
    j["generic_term"] = generic_term();
    j["extension"] = extensions.empty() ? Json() : Json(extensions[0].second);
    j["extensions"] = Json::object();
    for (const auto& e : extensions) j["extensions"][e.first] = e.second;
    j["gain"] = gain();
    j["confirmation"] = confirmation(d_.confirmation);
    j["self_test"] = self_test();
    j["next"] = Json::array();
    for (const NextMeasurement& n : d_.next)
      j["next"].push_back({{"name", n.name},
                           {"cost", n.cost},
                           {"information_nats", n.information},
                           {"clear_verdict", n.clear_verdict}});
    j["nuisances"] = nuisances();
    j["claims"] = claims();
    j["untested"] = Json::array();
    for (const Untested& u : d_.library.untested) j["untested"].push_back({{"effect", u.effect}, {"reason", u.reason}});
    j["runs"] = {{"budget", study_.budget}, {"planned", d_.ledger.planned}, {"used", d_.ledger.runs.size()}};
    j["common_random_numbers"] = d_.model.common_numbers;
    j["assumptions"] = study_.assumptions;
    j["notes"] = d_.notes;
    j["hints"] = d_.hints;
    return j;
  }

  std::string sentence() const {
    switch (v_.verdict) {
      case Verdict::named: {
        std::string out = v_.named.size() == 1 ? "The data name a cause: " : "The data name two causes: ";
        for (std::size_t k = 0; k < v_.named.size(); ++k) out += (k > 0 ? "; and " : "") + words_of(v_.named[k]);
        return out + ". On data that were not fitted it predicts better than the recalibrated old model by " +
               format_number(std::round(10 * v_.gain.log_score) / 10) + " nats.";
      }
      case Verdict::none:
        return "Nothing is shown to be wrong: what was measured and the recalibrated simulation agree within their "
               "uncertainties." +
               best_next();
      case Verdict::unknown: {
        std::string out = "Something is wrong that is not in the library";
        for (std::size_t k = 0; k < d_.terms.size(); ++k)
          out += (k == 0 ? ". It looks like this: " : "; ") + d_.terms[k].words;
        return out + "." + generic_words();
      }
      default: {
        std::string out = "No cause can be named: " + v_.reason + ".";
        std::string left;
        for (const std::size_t k : v_.set)
          left += (left.empty() ? "" : ", ") + std::string(k < effects_    ? d_.model.effects[k].id
                                                           : k == effects_ ? "nothing"
                                                                           : "something outside the library");
        out += (v_.set.size() > 1 ? " Left are: " : " Likeliest is ") + left + ".";
        return out + best_next();
      }
    }
  }

 private:
  std::string best_next() const {
    return d_.next.empty() ? "" : " The measurement that would tell most for its cost: " + d_.next[0].name + ".";
  }
  const Candidate& candidate(std::size_t e) const { return d_.library.candidates[d_.kept[e]]; }

  std::string data_hash() const {
    Sha256 hash;
    for (const StudyObservable& o : study_.observables)
      for (const std::vector<double>* v : {&o.measured.x, &o.measured.y, &o.measured.sd})
        hash.add(v->data(), v->size() * sizeof(double));
    return hash.finish();
  }

  static constexpr double normal_95 = 1.645;

  /// An amplitude and the ends of its interval in the unit of the parameter, inside its range.
  static Json strength(const Candidate& c, const Vector& amplitude, double low, double high, double sd) {
    if (c.effect.one_sided || c.effect.components == 2) low = std::max(low, 0.0);
    low = c.off + c.orientation * low, high = c.off + c.orientation * high;
    if (low > high) std::swap(low, high);
    low = std::clamp(low, c.lowest, c.highest), high = std::clamp(high, c.lowest, c.highest);
    return {{"name", c.parameter},
            {"unit", c.unit},
            {"value", c.value(amplitude)},
            {"low", low},
            {"high", high},
            {"sd", sd},
            {"off", c.off},
            {"range", {c.lowest, c.highest}}};
  }

  /// Strength of a cause with its 90 % interval, in the unit of its parameter.
  Json parameters(std::size_t e) const {
    const Candidate& c = candidate(e);
    const infer::SingleFit& fit = v_.posterior.fits[e];
    Vector amplitude = fit.amplitude;
    double low = fit.low, high = fit.high, sd = fit.sd;
    for (std::size_t k = 0; k < d_.explained.size(); ++k) {
      if (d_.explained[k] != e) continue;
      amplitude = d_.amplitudes[k];
      // Beside another effect, or fitted by runs: as wide as alone, or as the runs say where that is wider.
      if (k < d_.amplitude_sd.size()) sd = std::max(sd, d_.amplitude_sd[k]);
      const double size = amplitude.size() == 1 ? amplitude[0] : amplitude.norm();
      low = size - normal_95 * sd, high = size + normal_95 * sd;
    }
    Json out = Json::array();
    out.push_back(strength(c, amplitude, low, high, sd));
    if (!c.direction.empty()) {
      const double angle = c.info.parameter(c.direction)->off + c.angle(amplitude);
      out.push_back({{"name", c.direction}, {"unit", "deg"}, {"value", angle}});
    }
    return out;
  }

  std::string words_of(std::size_t e) const {
    const Json p = parameters(e)[0];
    const std::string unit = p["unit"];
    std::string summary = candidate(e).info.summary;
    if (!summary.empty() && summary.back() == '.') summary.pop_back();
    return d_.model.effects[e].id + " (" + summary + "), " + p["name"].get<std::string>() + " = " +
           brief_quantity(p["value"], unit) + " (90 % interval " + brief_quantity(p["low"], unit) + " to " +
           brief_quantity(p["high"], unit) + "), probability " + percent(v_.probability[e]);
  }

  Json causes() const {
    Json out = Json::array();
    for (const std::size_t e : order_) {
      const Candidate& c = candidate(e);
      Json rivals = Json::array();
      for (const EffectRival& r : c.info.rivals) rivals.push_back({{"effect", r.effect}, {"separate", r.separate}});
      Json on = Json::object();
      for (std::size_t k = 0; k < c.cases.size(); ++k)
        if (c.cases[k]) on[study_.cases[k].name] = c.bound[k];
      out.push_back({{"id", c.info.id},
                     {"amplitude", c.parameter},
                     {"summary", c.info.summary},
                     {"probability", v_.probability[e]},
                     {"evidence", v_.posterior.inclusion[e]},
                     {"log_odds", v_.posterior.fits[e].odds},
                     {"named", std::count(v_.named.begin(), v_.named.end(), e) > 0},
                     {"dropped", std::count(d_.dropped.begin(), d_.dropped.end(), e) > 0},
                     {"parameters", parameters(e)},
                     {"signal_to_noise", d_.confusion.detectability[e]},
                     {"instrument", c.info.is_instrument},
                     {"on", on},
                     {"rivals", rivals}});
    }
    return out;
  }

  Json observables() const {
    Json out = Json::array();
    const infer::Observables& all = d_.model.observables;
    const infer::Matrix scatter = d_.model.scatter.covariance(all);
    for (std::size_t b = 0; b < all.blocks.size(); ++b) {
      const infer::Block& block = all.blocks[b];
      const StudyObservable& o = d_.measured.readings[b];
      const int first = all.first(b), n = all.size(b);
      const infer::BlockCheck& before = v_.before.blocks[b];
      const infer::BlockCheck& after = v_.after.blocks[b];
      const Vector mean = d_.before.segment(first, n);
      const Vector width = (v_.budget.systematic.diagonal().segment(first, n) + block.sd.cwiseAbs2()).cwiseSqrt();
      const infer::Term& strongest = d_.bank.terms[before.strongest];
      Json conditions = Json::object();
      for (const auto& c : o.conditions) conditions[c.first] = c.second;
      out.push_back({{"name", block.name},
                     {"kind", block.kind},
                     {"case", o.case_name},
                     {"sensor", o.sensor},
                     {"column", o.column},
                     {"unit", o.unit},
                     {"against", o.against},
                     {"x", o.measured.x},
                     {"log_x", block.log_x},
                     {"fit", list(block.fit)},
                     {"hold", list(block.hold)},
                     {"sd", list(block.sd)},
                     {"before", list(mean)},
                     {"after", list(d_.after.segment(first, n))},
                     {"band", list(width)},
                     {"z", -before.z},
                     {"p", before.p},
                     {"signed_error", -before.departure},
                     {"z_after", -after.z},
                     {"p_after", after.p},
                     {"looks_like", before.p < 0.05 ? strongest.family : ""},
                     {"conditions", conditions},
                     {"seed_scatter", std::sqrt(scatter(first, first))},
                     {"noise_estimated", o.measured.sd_estimated},
                     {"repeats", o.measured.repeats},
                     {"simulated_elsewhere", !o.simulated.empty()}});
    }
    return out;
  }

  Json events() const {
    Json out = Json::array();
    const infer::Observables& all = d_.model.observables;
    for (const infer::Event& e : v_.events)
      for (std::size_t b = 0; b < all.blocks.size(); ++b) {
        const int k = e.row - all.first(b);
        if (k < 0 || k >= all.size(b)) continue;
        out.push_back({{"observable", all.blocks[b].name}, {"x", all.blocks[b].x[k]}, {"z", e.z}});
      }
    return out;
  }

  Json confusability() const {
    Json ids = Json::array(), groups = Json::array();
    for (const infer::Effect& e : d_.model.effects) ids.push_back(e.id);
    for (const auto& g : d_.confusion.groups) {
      Json group = Json::array();
      for (const std::size_t e : g) group.push_back(d_.model.effects[e].id);
      groups.push_back(group);
    }
    return {{"ids", ids},
            {"cosine", matrix(d_.confusion.cosine)},
            {"distance", matrix(d_.confusion.distance)},
            {"groups", groups}};
  }

  Json terms() const {
    Json out = Json::array();
    for (const infer::UnknownTerm& t : d_.terms) {
      const infer::Term& term = d_.bank.terms[t.term];
      out.push_back({{"observable", d_.model.observables.blocks[term.block].name},
                     {"family", term.family},
                     {"place", term.place},
                     {"size", t.size},
                     {"size_sd", t.size_sd},
                     {"gain_nats", t.gain},
                     {"stability", t.stability},
                     {"words", t.words},
                     {"kind", "patch of the observable: interpolation only, no cause"}});
    }
    return out;
  }

  /// What fits best where nothing of the library does; no name of a cause.
  Json generic_term() const {
    const GenericFit& g = d_.generic;
    if (g.tried.empty()) return nullptr;
    const Candidate& best = d_.library.candidates[g.tried[0].candidate];
    Json tried = Json::array();
    for (const GenericFit::Trial& t : g.tried)
      tried.push_back({{"id", d_.library.candidates[t.candidate].info.id},
                       {"summary", d_.library.candidates[t.candidate].info.summary},
                       {"log_odds", t.log_odds}});
    return {{"id", best.info.id},
            {"summary", best.info.summary},
            {"kind", "generic term, no named cause"},
            {"accepted", g.accepted},
            {"reason", g.reason},
            {"parameters",
             {strength(best, g.amplitude, g.amplitude[0] - normal_95 * g.amplitude_sd,
                       g.amplitude[0] + normal_95 * g.amplitude_sd, g.amplitude_sd)}},
            {"fit_p", g.fit_p},
            {"held_out_log_score", g.gain},
            {"confirmation", confirmation(g.confirmation)},
            {"tried", tried}};
  }

  std::string generic_words() const {
    const GenericFit& g = d_.generic;
    if (g.tried.empty()) return "";
    const Candidate& best = d_.library.candidates[g.tried[0].candidate];
    if (!g.accepted) return " No generic term describes it: " + g.reason + ".";
    return " A generic term describes it, which is no named cause: " + best.info.id + ", " + best.parameter + " = " +
           brief_quantity(best.value(g.amplitude), "1") + ".";
  }

  Json gain() const {
    return {{"held_out_log_score", v_.gain.log_score},   {"sd", v_.gain.sd},
            {"needed", d_.options.gain_above},           {"error_before", v_.gain.error_before},
            {"error_after", v_.gain.error_after},        {"held_out", d_.measured.has_hold_out},
            {"split_repeats", d_.measured.split_repeats}};
  }

  static Json confirmation(const Confirmation& c) {
    if (!c.done) return nullptr;
    return {{"passed", c.passed},
            {"seeds", c.seeds},
            {"held_out_log_score", c.log_score},
            {"error_before", c.error_before},
            {"error_after", c.error_after},
            {"error_foretold", c.error_foretold},
            {"contradicted", c.contradicted},
            {"agreement_p", c.agreement},
            {"before", c.before},
            {"after", c.after}};
  }

  Json self_test() const {
    const infer::SelfTest& t = d_.self_test;
    Json powers = Json::array();
    for (const infer::SelfTest::Power& p : t.powers) {
      const Candidate& c = candidate(p.effect);
      powers.push_back({{"cause", d_.model.effects[p.effect].id},
                        {"strength", c.off + c.orientation * p.amplitude * c.effect.scale},
                        {"unit", c.unit},
                        {"studies", p.studies},
                        {"right", p.right},
                        {"wrong", p.wrong}});
    }
    return {{"controls", t.controls},
            {"controls_named", t.controls_named},
            {"powers", powers},
            {"calibration", {{"stated", t.calibration.stated}, {"observed", t.calibration.observed}}}};
  }

  Json nuisances() const {
    Json out = Json::array();
    for (std::size_t k = 0; k < study_.parameters.size(); ++k) {
      const StudyParameter& p = study_.parameters[k];
      const auto i = static_cast<Eigen::Index>(k);
      const double mean = prior_mean(p), sd = prior_sd(p);
      out.push_back({{"name", p.name},
                     {"unit", p.unit},
                     {"prior_mean", mean},
                     {"prior_sd", sd},
                     {"before", std::clamp(mean + sd * d_.u_before[i], p.low, p.high)},
                     {"after", std::clamp(mean + sd * d_.u_after[i], p.low, p.high)},
                     {"sd", sd * d_.u_sd[k]},
                     {"strained", std::fabs(d_.u_before[i]) > 2}});
    }
    return out;
  }

  Json claims() const {
    Json out = Json::array();
    for (const Claim& c : d_.claims)
      out.push_back({{"effect", c.effect},
                     {"observable", c.observable},
                     {"says", c.says},
                     {"verdict", c.verdict},
                     {"measured_minus_simulated", c.departure},
                     {"sd", c.departure_sd},
                     {"change_by_effect", c.change},
                     {"sentence", c.sentence}});
    return out;
  }

  const Study& study_;
  const StudyDiagnosis& d_;
  const infer::Diagnosis& v_;
  std::size_t effects_;
  std::vector<std::size_t> order_;
};

}  // namespace

std::string diagnosis_sentence(const Study& study, const StudyDiagnosis& d) {
  return DiagnosisText(study, d).sentence();
}

std::string diagnosis_json(const Study& study, const StudyDiagnosis& d,
                           const std::vector<std::pair<std::string, std::string>>& extensions) {
  return DiagnosisText(study, d).json(extensions).dump(2) + "\n";
}

std::string diagnosis_summary(const Study& study, const StudyDiagnosis& d) {
  std::string out =
      "verdict: " + std::string(infer::name(d.diagnosis.verdict)) + "\n" + diagnosis_sentence(study, d) + "\n";
  char line[300];
  std::snprintf(line, sizeof line, "%-32s %10s %9s %9s\n", "observable", "error", "z", "p");
  out += line;
  for (std::size_t b = 0; b < d.model.observables.blocks.size(); ++b) {
    const infer::BlockCheck& c = d.diagnosis.before.blocks[b];
    const std::string& unit = d.measured.readings[b].unit;
    // The error of the simulation, so that what it gives too much of is positive.
    std::snprintf(line, sizeof line, "%-32s %10s %+9.1f %9.3g\n", d.model.observables.blocks[b].name.c_str(),
                  brief_quantity(-c.departure, unit).c_str(), -c.z, c.p);
    out += line;
  }
  for (const Claim& c : d.claims) out += "claim: " + c.sentence + "\n";
  for (const std::string& n : d.notes) out += "note: " + n + "\n";
  for (const std::string& h : d.hints) out += "hint: " + h + "\n";
  return out;
}

}  // namespace calx
