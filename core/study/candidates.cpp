#include "study/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "config/document.hpp"
#include "config/node.hpp"
#include "plugin/effects.hpp"
#include "study/case_check.hpp"
#include "study/generic_terms.hpp"
#include "study/resolve.hpp"

namespace calx {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// What a study says of one effect.
struct Named {
  std::string pointer;
  std::map<std::string, std::string> on;
  std::map<std::string, double> shape;
  std::map<std::string, double> scale;  // by amplitude; none: that of the manifest
  std::vector<std::string> cases;
};

/// Effects that the case itself names, before they are expanded.
Json effects_of_case(const std::string& path, const std::vector<std::pair<std::string, std::string>>& set) {
  const Document document(read_text_file(path), path, set);
  const auto found = document.root().find("effects");
  return found == document.root().end() ? Json::array() : *found;
}

/// A typical strength for the only amplitude, or one by name.
std::map<std::string, double> read_scale(const Node& node, const EffectInfo& info) {
  std::vector<std::string> amplitudes;
  for (const EffectParameter& p : info.parameters)
    if (p.is_amplitude) amplitudes.push_back(p.name);
  if (!node.json().is_object()) {
    if (amplitudes.size() > 1)
      node.fail("effect " + info.id + " has several amplitudes; give {\"" + amplitudes[0] + "\": ...}");
    return {{amplitudes[0], node.number("1", Allow::above_zero)}};
  }
  std::map<std::string, double> out;
  for (const auto& entry : Object(node, "typical strengths by amplitude").entries()) {
    if (std::find(amplitudes.begin(), amplitudes.end(), entry.first) == amplitudes.end())
      entry.second.fail("effect " + info.id + " has no amplitude \"" + entry.first + "\"; " +
                        did_you_mean(entry.first, amplitudes));
    out[entry.first] = entry.second.number("1", Allow::above_zero);
  }
  return out;
}

std::map<std::string, Named> read_named(const Study& study, const std::vector<EffectInfo>& effects) {
  std::map<std::string, Named> out;
  Document document(Parameters{study.effects, "/effects", study.folder}, study.file);
  std::vector<std::string> known, cases;
  for (const EffectInfo& e : effects) known.push_back(e.id);
  for (const StudyCase& c : study.cases) cases.push_back(c.name);
  for (const Node& node : Node(document, document.root(), "/effects").items("effects")) {
    Object o(node, "an effect of the library");
    const Node id = o.need("effect", "the id of an effect, such as \"calx.canister-tilt\"");
    const std::string name = id.name_of("effect among the plugins found", known);
    if (out.count(name)) id.fail("\"" + name + "\" stands twice");
    const EffectInfo& info =
        *std::find_if(effects.begin(), effects.end(), [&](const EffectInfo& e) { return e.id == name; });
    Named n;
    n.pointer = node.pointer();
    for (const auto& entry : o.section("on", "names by role").entries()) {
      if (!info.role(entry.first)) entry.second.fail("effect " + name + " has no role \"" + entry.first + "\"");
      n.on[entry.first] = entry.second.text("a name in the case");
    }
    std::vector<std::string> shapes;
    for (const EffectParameter& p : info.parameters)
      if (!p.is_amplitude) shapes.push_back(p.name);
    for (const auto& entry : o.section("parameters", "parameters that are no amplitude").entries()) {
      if (std::find(shapes.begin(), shapes.end(), entry.first) == shapes.end())
        entry.second.fail("effect " + name + " has no parameter \"" + entry.first + "\" with a preset; " +
                          did_you_mean(entry.first, shapes));
      n.shape[entry.first] = entry.second.number("1");
    }
    if (const auto scale = o.find("scale")) n.scale = read_scale(*scale, info);
    n.cases = o.names("cases", "case", cases);
    o.done();
    out[name] = n;
  }
  return out;
}

/// roles: of the study, names by role.
Candidate make_candidate(const EffectInfo& info, const EffectParameter& p, const Json& roles, const Named* named,
                         double step_scales) {
  Candidate c;
  c.info = info, c.parameter = p.name, c.unit = p.unit;
  c.off = p.off, c.lowest = p.lowest, c.highest = p.highest;
  c.orientation = p.sign == EffectParameter::Sign::negative ? -1 : 1;
  for (const EffectRole& r : info.roles)
    if (roles.contains(r.name) && roles[r.name].is_string()) c.on[r.name] = roles[r.name].get<std::string>();
  if (named) {
    for (const auto& on : named->on) c.on[on.first] = on.second;
    c.shape = named->shape;
  }
  for (const EffectParameter& q : info.parameters)
    if (q.direction_of == p.name && c.shape.count(q.name) == 0) c.direction = q.name;
  const auto amplitudes = std::count_if(info.parameters.begin(), info.parameters.end(),
                                        [](const EffectParameter& q) { return q.is_amplitude; });
  c.effect.id = info.id + (amplitudes > 1 ? " " + p.name : "");
  c.effect.components = c.direction.empty() ? 1 : 2;
  c.effect.one_sided = c.direction.empty() && p.sign != EffectParameter::Sign::any;
  c.effect.instrument = info.is_instrument;
  const double above = p.highest - p.off, below = p.off - p.lowest;
  const double room = p.sign == EffectParameter::Sign::positive   ? above
                      : p.sign == EffectParameter::Sign::negative ? below
                      : c.direction.empty()                       ? std::min(above, below)
                                                                  : above;
  const double wanted = named && named->scale.count(p.name) ? named->scale.at(p.name) : p.scale;
  c.effect.scale = std::min(wanted, room / step_scales);
  return c;
}

/// Kinds of observables that tell the same thing in other words: what changes one changes all.
std::string family_of(const std::string& kind) {
  static const std::map<std::string, std::string> families = {
      {"mass-per-cycle", "flow"},    {"mass-after-cycles", "flow"}, {"load-cell", "flow"},
      {"folded-flow", "flow"},       {"hopper-discharge", "flow"},  {"flow-rate", "flow"},
      {"residue", "flow"},           {"drained-angle", "pile"},     {"static-angle", "pile"},
      {"dynamic-angle", "pile"},     {"pile-profile", "pile"},      {"fill-height", "pile"},
      {"bulk-density", "packing"},   {"tapped-density", "packing"}, {"compressibility", "packing"},
      {"wall-friction", "friction"}, {"shear", "friction"}};
  const auto found = families.find(kind);
  return found == families.end() ? kind : found->second;
}

bool touched(const Study& study, const StudyCase& c, const EffectInfo& info) {
  return std::any_of(study.observables.begin(), study.observables.end(), [&](const StudyObservable& o) {
    return o.case_name == c.name &&
           (o.kind == "other" || std::any_of(info.touches.begin(), info.touches.end(), [&](const std::string& kind) {
              return family_of(kind) == family_of(o.kind);
            }));
  });
}

/// The message without the place in the case, which the reader of a study does not know.
std::string plain_reason(const std::string& what) {
  const std::size_t at = what.find(": ");
  return at == std::string::npos ? what : what.substr(at + 2);
}

std::vector<double> usual_values(const Study& study) {
  std::vector<double> out;
  for (const StudyParameter& p : study.parameters) out.push_back(prior_mean(p));
  return out;
}

/// Where the case has the effect already, a dose adds to what is there, in either direction.
void start_from_case(Candidate& c, const StudyCase& which) {
  for (const Json& e : effects_of_case(which.path, which.set)) {
    if (!e.is_object() || e.value("effect", "") != c.info.id) continue;
    const auto parameters = e.find("parameters");
    if (parameters == e.end() || !parameters->is_object() || !parameters->contains(c.parameter)) continue;
    const Json& value = (*parameters)[c.parameter];
    if (!value.is_number() || value.get<double>() == c.off) continue;
    c.off = value.get<double>(), c.orientation = 1;
    c.effect.one_sided = false;
  }
}

/// Fills in the cases; the reason why there is none, else empty.
std::string place(const Study& study, Candidate& c, const Named* named, double step_scales) {
  std::string reason;
  bool any = false;
  c.cases.assign(study.cases.size(), false);
  c.bound.resize(study.cases.size());
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const StudyCase& which = study.cases[k];
    if (named && !named->cases.empty() &&
        std::find(named->cases.begin(), named->cases.end(), which.name) == named->cases.end())
      continue;
    if (!touched(study, which, c.info)) continue;
    c.cases[k] = true;
    start_from_case(c, which);
    const infer::Vector amplitude = step_scales * c.effect.scale * infer::Vector::Unit(c.effect.components, 0);
    try {
      for (const bool reduced : {false, true}) {
        if (reduced && which.reduced.empty()) continue;
        const RunRequest request = dosed_request(study, k, usual_values(study), study.seed, {{&c, amplitude}}, reduced);
        const Json resolved = Json::parse(resolve(request, study.executor.plugin_path).resolved);
        for (const Json& e : resolved["effects"])
          if (e["effect"] == c.info.id) c.bound[k] = e["on"].get<std::map<std::string, std::string>>();
        try_run(request, study.executor.plugin_path);
      }
      any = true;
    } catch (const Error& e) {
      c.cases[k] = false;
      if (named && !named->cases.empty())
        throw Error(e.fault(), study.file + " " + named->pointer + ": case \"" + which.name + "\": " + e.what());
      reason = "case \"" + which.name + "\": " + plain_reason(e.what());
    }
  }
  if (any) return "";
  return reason.empty() ? "touches none of the kinds of observables that were measured" : reason;
}

Json read_roles(const Study& study) {
  Json roles = parse_json(study.roles, study.file, "/roles");
  if (!roles.is_object())
    throw Error(Fault::settings, study.file + " /roles: " + shown(roles) + "; must hold names in the cases by role");
  return roles;
}

/// Every amplitude of the effect that fits a case; what fits none is untested, and an error where the study names it.
void add_candidates(const Study& study, const EffectInfo& info, const Json& roles, const Named* own, double step_scales,
                    Library& out) {
  for (const EffectParameter& p : info.parameters) {
    if (!p.is_amplitude) continue;
    Candidate c = make_candidate(info, p, roles, own, step_scales);
    c.named = own != nullptr;
    for (const StudyObservable& o : study.observables)
      c.touched += static_cast<std::size_t>(std::count(info.touches.begin(), info.touches.end(), o.kind));
    // Where the case refuses an effect at its usual trial strength, for its time step for instance, less may do.
    std::string reason;
    for (const double weaker : {1.0, 0.5, 0.5}) {
      c.effect.scale *= weaker;
      reason = place(study, c, own, step_scales);
      if (reason.empty()) break;
    }
    if (reason.empty()) {
      out.candidates.push_back(c);
    } else if (own) {
      throw Error(Fault::settings, study.file + " " + own->pointer + ": effect " + info.id +
                                       " cannot act in any case of the study; " + reason);
    } else if (out.untested.empty() || out.untested.back().effect != info.id) {
      out.untested.push_back({info.id, reason});
    }
  }
}

}  // namespace

double Candidate::value(const infer::Vector& amplitude) const {
  const double size = amplitude.size() == 1 ? amplitude[0] : amplitude.norm();
  return std::clamp(off + orientation * size, lowest, highest);
}

bool Candidate::allows(const infer::Vector& amplitude) const {
  const double size = amplitude.size() == 1 ? amplitude[0] : amplitude.norm(), at = off + orientation * size;
  return at >= lowest && at <= highest;
}

std::vector<std::pair<std::string, double>> Candidate::settings(const infer::Vector& amplitude) const {
  std::vector<std::pair<std::string, double>> out(shape.begin(), shape.end());
  out.emplace_back(parameter, value(amplitude));
  if (!direction.empty()) out.emplace_back(direction, info.parameter(direction)->off + angle(amplitude));
  return out;
}

double Candidate::angle(const infer::Vector& amplitude) const {
  return amplitude.size() == 1 ? 0 : std::atan2(amplitude[1], amplitude[0]) / degree;
}

Library find_library(const Study& study, double step_scales) {
  const std::vector<EffectInfo> effects = list_effects(plugin_search_path(study.executor.plugin_path));
  const std::map<std::string, Named> named = read_named(study, effects);
  const Json roles = read_roles(study);
  Library out;
  for (const EffectInfo& info : effects) {
    const auto found = named.find(info.id);
    const Named* own = found == named.end() ? nullptr : &found->second;
    if (!own && (study.named_effects_only || info.id.compare(0, 5, "calx.") != 0)) continue;
    add_candidates(study, info, roles, own, step_scales, out);
  }
  return out;
}

Library find_generic_terms(const Study& study, double step_scales) {
  const std::vector<EffectInfo> effects = list_effects(plugin_search_path(study.executor.plugin_path));
  const Json roles = read_roles(study);
  Library out;
  for (const GenericTerm& term : read_generic_terms(study))
    for (const EffectInfo& info : effects)
      if (info.id == term.id()) add_candidates(study, info, roles, nullptr, step_scales, out);
  return out;
}

RunRequest dosed_request(const Study& study, std::size_t case_number, const std::vector<double>& values,
                         std::uint64_t seed, const std::vector<Dose>& doses, bool reduced) {
  const StudyCase& which = study.cases[case_number];
  RunRequest request = request_for(study, which, values, seed, reduced);
  Json effects;
  for (const Dose& dose : doses) {
    const Candidate& c = *dose.candidate;
    if (!c.cases[case_number] || dose.amplitude.isZero(0)) continue;
    if (effects.is_null()) effects = effects_of_case(request.case_path, which.set);
    Json entry = {{"effect", c.info.id}, {"parameters", Json::object()}};
    for (const auto& on : c.on) entry["on"][on.first] = on.second;
    // One entry per effect: another amplitude of it may be there already, from the case or from another dose.
    const auto same =
        std::find_if(effects.begin(), effects.end(), [&](const Json& e) { return e.value("effect", "") == c.info.id; });
    Json& to = same == effects.end() ? effects.emplace_back(entry) : *same;
    Json& parameters = to["parameters"];
    for (const EffectParameter& p : c.info.parameters)
      if (p.is_amplitude && !parameters.contains(p.name)) parameters[p.name] = p.off;
    for (const auto& setting : c.settings(dose.amplitude)) parameters[setting.first] = setting.second;
  }
  if (!effects.is_null()) request.overrides.emplace_back("/effects", effects.dump());
  request.may_be_refused = !effects.is_null();
  return request;
}

}  // namespace calx
