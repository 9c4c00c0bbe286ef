#include "report/diagnosis_page_result.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "io/io.hpp"
#include "report/series_csv.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Result = DiagnosisResult;

/// An empty object or list stands for what is not there.
const Json& member(const Json& object, const char* key) {
  static const Json absent;
  const auto at = object.is_object() ? object.find(key) : object.end();
  return at == object.end() ? absent : *at;
}

double number(const Json& object, const char* key, double otherwise = Result::unknown) {
  const Json& v = member(object, key);
  return v.is_number() ? v.get<double>() : otherwise;
}

bool flag(const Json& object, const char* key, bool otherwise = false) {
  const Json& v = member(object, key);
  return v.is_boolean() ? v.get<bool>() : otherwise;
}

std::string plain(const Json& v) {
  if (v.is_string()) return v.get<std::string>();
  return v.is_null() ? "" : v.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string text(const Json& object, const char* key) { return plain(member(object, key)); }

std::vector<double> numbers(const Json& list) {
  std::vector<double> out;
  if (!list.is_array()) return out;
  for (const Json& v : list) out.push_back(v.is_number() ? v.get<double>() : Result::unknown);
  return out;
}

std::vector<std::string> texts(const Json& list) {
  std::vector<std::string> out;
  if (!list.is_array()) return out;
  for (const Json& v : list) out.push_back(plain(v));
  return out;
}

/// What read makes of each object of a list.
template <class Read>
auto each(const Json& object, const char* key, Read read) {
  std::vector<decltype(read(object))> out;
  const Json& list = member(object, key);
  if (!list.is_array()) return out;
  for (const Json& v : list)
    if (v.is_object()) out.push_back(read(v));
  return out;
}

Result::Amount read_amount(const Json& j) {
  Result::Amount a;
  a.name = text(j, "name"), a.unit = text(j, "unit");
  a.value = number(j, "value"), a.low = number(j, "low"), a.high = number(j, "high"), a.off = number(j, "off");
  const std::vector<double> range = numbers(member(j, "range"));
  if (range.size() == 2) a.lowest = range[0], a.highest = range[1];
  return a;
}

Result::Cause read_cause(const Json& j) {
  Result::Cause c;
  c.id = text(j, "id"), c.label = text(j, "amplitude"), c.summary = text(j, "summary");
  c.probability = number(j, "probability", 0);
  c.evidence = number(j, "evidence", c.probability);
  c.signal_to_noise = number(j, "signal_to_noise");
  c.named = flag(j, "named"), c.is_dropped = flag(j, "dropped"), c.is_instrument = flag(j, "instrument");
  c.parameters = each(j, "parameters", read_amount);
  c.rivals = each(j, "rivals", [](const Json& r) { return Result::Rival{text(r, "effect"), text(r, "separate")}; });
  return c;
}

/// An effect of several parameters may be a cause by each; labels are then as elsewhere in diagnosis.json.
void label(std::vector<Result::Cause>& causes) {
  for (Result::Cause& c : causes) {
    const bool shared =
        std::count_if(causes.begin(), causes.end(), [&](const Result::Cause& other) { return other.id == c.id; }) > 1;
    c.label = c.id + (shared ? " " + c.label : "");
  }
}

Result::Observable read_observable(const Json& j) {
  Result::Observable o;
  o.name = text(j, "name"), o.kind = text(j, "kind"), o.case_name = text(j, "case");
  o.unit = text(j, "unit"), o.against = text(j, "against"), o.looks_like = text(j, "looks_like");
  o.x = numbers(member(j, "x")), o.fit = numbers(member(j, "fit")), o.hold = numbers(member(j, "hold"));
  o.sd = numbers(member(j, "sd")), o.band = numbers(member(j, "band"));
  o.before = numbers(member(j, "before")), o.after = numbers(member(j, "after"));
  o.log_x = flag(j, "log_x"), o.noise_estimated = flag(j, "noise_estimated");
  o.simulated_elsewhere = flag(j, "simulated_elsewhere");
  o.z = number(j, "z"), o.p = number(j, "p"), o.signed_error = number(j, "signed_error");
  o.z_after = number(j, "z_after"), o.p_after = number(j, "p_after");
  o.seed_scatter = number(j, "seed_scatter"), o.repeats = number(j, "repeats");
  const Json& conditions = member(j, "conditions");
  if (conditions.is_object())
    for (const auto& [name, value] : conditions.items()) o.conditions.emplace_back(name, plain(value));
  // Figures of a single number stand at no place; places that do not fit the figures would mislead.
  const std::size_t n = std::max({o.before.size(), o.fit.size(), o.hold.size()});
  if (o.x.size() != n) {
    o.x.resize(n);
    for (std::size_t k = 0; k < n; ++k) o.x[k] = static_cast<double>(k);
  }
  return o;
}

Result::UnknownTerm read_term(const Json& j) {
  return {text(j, "observable"), text(j, "family"), text(j, "words"), number(j, "gain_nats"), number(j, "stability")};
}

Result::GenericTerm read_generic(const Json& j) {
  Result::GenericTerm g;
  if (!j.is_object()) return g;
  g.id = text(j, "id"), g.summary = text(j, "summary"), g.reason = text(j, "reason");
  g.accepted = flag(j, "accepted");
  const std::vector<Result::Amount> amounts = each(j, "parameters", read_amount);
  if (!amounts.empty()) g.amount = amounts[0];
  const Json& runs = member(j, "confirmation");
  g.gain = number(runs, "held_out_log_score", number(j, "held_out_log_score"));
  g.error_before = number(runs, "error_before"), g.error_after = number(runs, "error_after");
  g.tried = each(j, "tried", [](const Json& t) { return std::make_pair(text(t, "id"), number(t, "log_odds")); });
  return g;
}

Result::Parameter read_parameter(const Json& j) {
  Result::Parameter p;
  p.name = text(j, "name"), p.unit = text(j, "unit");
  p.prior_mean = number(j, "prior_mean"), p.prior_sd = number(j, "prior_sd");
  p.before = number(j, "before"), p.after = number(j, "after"), p.sd = number(j, "sd");
  return p;
}

Result::Power read_power(const Json& j) {
  Result::Power p;
  p.cause = text(j, "cause"), p.unit = text(j, "unit"), p.strength = number(j, "strength");
  p.studies = number(j, "studies", 0), p.right = number(j, "right", 0), p.wrong = number(j, "wrong", 0);
  return p;
}

void read_confusability(Result& d, const Json& j) {
  d.ids = texts(member(j, "ids"));
  const Json& rows = member(j, "distance");
  if (rows.is_array())
    for (const Json& row : rows) d.distance.push_back(numbers(row));
  // A matrix of another size belongs to no list of causes.
  bool square = d.distance.size() == d.ids.size();
  for (const std::vector<double>& row : d.distance) square = square && row.size() == d.ids.size();
  if (!square) d.ids.clear(), d.distance.clear();
  const Json& groups = member(j, "groups");
  if (groups.is_array())
    for (const Json& group : groups) d.groups.push_back(texts(group));
}

void read_worth(Result& d, const Json& j) {
  const Json& gain = member(j, "gain");
  d.gain = number(gain, "held_out_log_score"), d.gain_sd = number(gain, "sd"), d.gain_needed = number(gain, "needed");
  // A gain that was never computed is written as zero with no spread.
  if (d.gain == 0 && d.gain_sd == 0) d.gain = Result::unknown;
  d.held_out = flag(gain, "held_out", true), d.split_repeats = flag(gain, "split_repeats");
  const Json& runs = member(j, "confirmation");
  auto& c = d.confirmation;
  c.done = runs.is_object(), c.passed = flag(runs, "passed");
  c.seeds = number(runs, "seeds"), c.gain = number(runs, "held_out_log_score");
  c.error_before = number(runs, "error_before"), c.error_after = number(runs, "error_after");
  c.agreement_p = number(runs, "agreement_p");
  c.error_foretold = number(runs, "error_foretold"), c.contradicted = flag(runs, "contradicted");
  c.before = numbers(member(runs, "before")), c.after = numbers(member(runs, "after"));
  const Json& test = member(j, "self_test");
  d.controls = number(test, "controls", 0), d.controls_named = number(test, "controls_named", 0);
  d.powers = each(test, "powers", read_power);
  d.stated = numbers(member(member(test, "calibration"), "stated"));
  d.observed = numbers(member(member(test, "calibration"), "observed"));
}

void read_extensions(Result& d, const Json& j) {
  const Json& paths = member(j, "extensions");
  if (!paths.is_object()) return;
  for (const auto& [case_name, path] : paths.items()) {
    const std::string file = d.dir + "/" + plain(path);
    d.extensions.push_back({case_name, plain(path), fs::is_regular_file(file) ? read_text(file) : ""});
  }
}

void read_cost(Result& d) {
  if (fs::exists(d.dir + "/cost.json")) {
    const Json cost = Json::parse(read_text(d.dir + "/cost.json"), nullptr, false);
    d.has_cost = cost.is_object();
    d.runs = number(cost, "runs"), d.cached = number(cost, "cached"), d.failed = number(cost, "failed");
    d.run_seconds = number(cost, "run_seconds"), d.executor = text(cost, "executor");
  }
  if (!fs::exists(d.dir + "/runs.csv")) return;
  std::istringstream lines(read_text(d.dir + "/runs.csv"));
  for (std::string line; std::getline(lines, line);) d.run_rows.push_back(csv_cells(line));
}

}  // namespace

std::vector<const Result::Cause*> Result::named() const {
  std::vector<const Cause*> out;
  for (const Cause& c : causes)
    if (c.named) out.push_back(&c);
  return out;
}

DiagnosisResult read_diagnosis(const std::string& dir) {
  const std::string file = dir + "/diagnosis.json";
  const Json j = Json::parse(read_text(file), nullptr, false);
  if (j.is_discarded()) throw Error(Fault::files, file + ": is no valid JSON; run calx diagnose again");
  if (!member(j, "verdict").is_string())
    throw Error(Fault::files, file + ": holds no \"verdict\"; must be what calx diagnose wrote");
  Result d;
  d.dir = dir;
  d.title = text(j, "title"), d.study = text(j, "study"), d.data_sha256 = text(j, "data_sha256");
  d.calx = text(j, "calx"), d.seed = text(j, "seed");
  d.verdict = text(j, "verdict"), d.reason = text(j, "reason"), d.sentence = text(j, "sentence");
  d.causes = each(j, "causes", read_cause);
  label(d.causes);
  std::stable_sort(d.causes.begin(), d.causes.end(),
                   [](const Result::Cause& a, const Result::Cause& b) { return a.evidence > b.evidence; });
  const Json& evidence = member(j, "evidence");
  d.none = number(evidence, "none"), d.unlisted = number(evidence, "unknown");
  d.fit_p = number(evidence, "fit_p"), d.fit_p_with_named = number(evidence, "fit_p_with_named");
  d.set = texts(member(j, "set")), d.after_holds = texts(member(j, "after_holds"));
  d.observables = each(j, "observables", read_observable);
  d.events = each(j, "events", [](const Json& e) {
    return Result::Event{text(e, "observable"), number(e, "x"), number(e, "z")};
  });
  read_confusability(d, member(j, "confusability"));
  d.terms = each(j, "unknown_terms", read_term);
  d.generic = read_generic(member(j, "generic_term"));
  read_extensions(d, j);
  read_worth(d, j);
  d.next = each(j, "next", [](const Json& n) {
    return Result::Measurement{text(n, "name"), number(n, "cost"), number(n, "information_nats"),
                               number(n, "clear_verdict")};
  });
  d.parameters = each(j, "nuisances", read_parameter);
  d.claims = each(j, "claims", [](const Json& c) {
    return Result::Claim{text(c, "effect"), text(c, "says"), text(c, "verdict"), text(c, "sentence")};
  });
  for (const Json& u : member(j, "untested")) d.untested.emplace_back(text(u, "effect"), text(u, "reason"));
  const Json& runs = member(j, "runs");
  d.budget = number(runs, "budget"), d.planned = number(runs, "planned"), d.used = number(runs, "used");
  d.assumptions = texts(member(j, "assumptions")), d.notes = texts(member(j, "notes"));
  d.hints = texts(member(j, "hints"));
  read_cost(d);
  return d;
}

}  // namespace calx
