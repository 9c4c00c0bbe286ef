#include "study/study.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/column_name.hpp"
#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/node.hpp"
#include "study/case_check.hpp"
#include "study/measured.hpp"

namespace calx {
namespace {

template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  std::vector<std::string> out;
  for (const T& t : things) out.push_back(t.name);
  return out;
}

template <class T>
void check_new_name(const Node& node, const std::string& name, const std::vector<T>& before) {
  check_name(node, name);
  for (const T& t : before)
    if (t.name == name) node.fail("\"" + name + "\" stands twice; names must differ");
}

std::size_t whole(Object& o, const std::string& key, std::uint64_t lowest, std::size_t preset) {
  const auto n = o.find(key);
  return n ? static_cast<std::size_t>(n->whole(lowest)) : preset;
}

class StudyReader {
 public:
  StudyReader(Document& document) : document_(document) {}

  Study read() {
    const Node top(document_, document_.root(), "");
    Object root(top, "a study");
    study_.file = document_.file();
    study_.folder = document_.folder();
    root.has("$schema");
    const Node version = root.need("calx_study", "must be 1, the version of the format");
    if (!version.json().is_number() || version.json().get<double>() != 1)
      version.fail(shown(version.json()) + " is not a version this program reads; must be 1");
    study_.title = root.text("title", "a line of text");
    if (study_.title.empty()) study_.title = std::filesystem::path(study_.file).stem().string();
    read_cases(root);
    read_parameters(root);
    read_observables(root);
    study_.seeds = whole(root, "seeds", 1, study_.seeds);
    if (const auto n = root.find("seed")) study_.seed = n->whole(0);
    Object budget = root.section("budget", "the budget of runs");
    study_.budget = whole(budget, "runs", 4, study_.budget);
    budget.done();
    read_executor(root);
    for (const Node& n : root.items("assumptions", "texts"))
      study_.assumptions.push_back(n.text("one assumption in words"));
    const auto keep = [&](const char* key, std::string& to) {
      if (const auto n = root.find(key)) to = n->json().dump();
    };
    keep("effects", study_.effects);
    keep("experiments", study_.experiments);
    keep("roles", study_.roles);
    keep("claims", study_.claims);
    keep("generic_terms", study_.generic_terms);
    study_.named_effects_only = root.choice("library", "a library of effects", {"calx", "named"}, 0) == 1;
    root.done();
    return study_;
  }

 private:
  void read_cases(Object& root) {
    for (const auto& entry : Object(root.need("cases", "the cases to run by name"), "cases by name").entries()) {
      check_new_name(entry.second, entry.first, study_.cases);
      Object o(entry.second, "a case of the study");
      StudyCase c;
      c.name = entry.first;
      c.pointer = entry.second.pointer();
      c.path = document_.absolute_path(o.need("case", "the path of a case file").text("the path of a case file"));
      for (const auto& set : o.section("set", "values by JSON pointer").entries()) {
        if (set.first.empty() || set.first[0] != '/')
          set.second.fail("\"" + set.first + "\" is no JSON pointer; it must start with /, as /time/end");
        c.set.emplace_back(set.first, set.second.json().dump());
      }
      if (const auto n = o.find("reduced")) c.reduced = document_.absolute_path(n->text("the path of a case file"));
      c.reduced_tolerance = o.number("reduced_tolerance", "1", c.reduced_tolerance, Allow::above_zero);
      o.done();
      study_.cases.push_back(c);
    }
    if (study_.cases.empty()) document_.fail("/cases", "is empty; at least one case is needed");
  }

  void read_parameters(Object& root) {
    const Node list = root.need("parameters", "the parameters to find, with their ranges");
    for (const Node& node : list.items("parameters")) {
      Object o(node, "a parameter");
      StudyParameter p;
      p.pointer = node.pointer();
      const Node name = o.need("name", "what the parameter is called");
      p.name = name.text("a name");
      check_new_name(name, p.name, study_.parameters);
      const auto unit = o.find("unit");
      p.unit = unit ? unit->text("a unit, \"1\" for none") : "1";
      if (unit) unit_factor(*unit, p.unit, p.unit, "the parameter");
      for (const Node& n : o.need("set", "the JSON pointers that take its value").items("JSON pointers")) {
        p.set.push_back(n.text("a JSON pointer such as /contacts/0/parameters/friction"));
        if (p.set.back()[0] != '/')
          n.fail("\"" + p.set.back() +
                 "\" is no JSON pointer; it must start with /, as /contacts/0/parameters/friction");
      }
      if (p.set.empty()) node.fail("\"set\" is empty; at least one JSON pointer is needed");
      p.cases = o.names("cases", "case", names_of(study_.cases));
      if (p.cases.empty()) p.cases = names_of(study_.cases);
      read_range(o, p);
      o.done();
      study_.parameters.push_back(p);
    }
  }

  static void read_range(Object& o, StudyParameter& p) {
    const Node node = o.need("range", "the lowest and the highest value");
    const std::vector<Node> ends = node.items("a lowest and a highest value");
    if (ends.size() != 2) node.fail(shown(node.json()) + "; must be the lowest and the highest value");
    // Values are in the parameter's own unit, so nothing is converted here.
    p.low = ends[0].number("1");
    p.high = ends[1].number("1");
    if (!(p.low < p.high))
      node.fail("the lowest value " + format_quantity(p.low, p.unit) + " is not below the highest " +
                format_quantity(p.high, p.unit));
    const auto prior = o.find("prior");
    if (!prior) return;
    if (prior->json().is_string()) {
      prior->choice("a prior", {"uniform"});
      return;
    }
    Object kinds(*prior, "\"uniform\" or {\"normal\": {\"mean\": 0.5, \"sd\": 0.1}}");
    Object normal(kinds.need("normal", "{\"mean\": 0.5, \"sd\": 0.1}"), "a normal prior");
    p.prior = StudyParameter::Prior::normal;
    const Node mean = normal.need("mean", "of the prior, in the parameter's unit");
    p.mean = mean.number("1");
    if (p.mean < p.low || p.mean > p.high)
      mean.fail(format_quantity(p.mean, p.unit) + " is outside of the range " + format_number(p.low) + " to " +
                format_quantity(p.high, p.unit));
    p.sd = normal.need("sd", "of the prior, in the parameter's unit").number("1", Allow::above_zero);
    normal.done();
    kinds.done();
  }

  void read_observables(Object& root) {
    const Node list = root.need("observables", "what was measured");
    std::vector<std::string> kinds;
    for (const auto& kind : observable_kinds()) kinds.push_back(kind.first);
    for (const Node& node : list.items("observables")) {
      Object o(node, "an observable");
      StudyObservable b;
      b.pointer = node.pointer();
      const Node name = o.need("name", "what the observable is called");
      b.name = name.text("a name");
      check_new_name(name, b.name, study_.observables);
      const Node kind = o.need("kind", "what was measured: " + quoted_list(kinds));
      b.kind = kind.name_of("kind of observable", kinds);
      read_reading(o, study_.cases, b);
      b.use = o.choice("use", "a use", {"fit", "hold-out"}, 0) == 0 ? StudyObservable::Use::fit
                                                                    : StudyObservable::Use::hold_out;
      read_measured(o, b);
      if (const auto n = o.find("simulated")) read_simulated(*n, b);
      for (const auto& c : o.section("conditions", "numbers by name").entries())
        b.conditions.emplace_back(c.first, c.second.number("1"));
      o.done();
      study_.observables.push_back(b);
    }
    const auto fits = [](const StudyObservable& b) { return b.use == StudyObservable::Use::fit; };
    if (std::none_of(study_.observables.begin(), study_.observables.end(), fits))
      list.fail("holds no observable of \"use\": \"fit\"; at least one is needed");
  }

  static void read_simulated(const Node& node, StudyObservable& b) {
    Object o(node, "what another program gave: {\"value\": 40.5, \"sd\": 0.5}");
    if (const auto values = o.find("values"))
      b.simulated = read_numbers(*values, b.unit);
    else
      b.simulated = {o.need("value", "a number, or \"values\"").number(b.unit)};
    if (const auto sd = o.find("sd")) b.simulated_sd = sd->number(b.unit, Allow::not_negative);
    o.done();
    if (b.simulated.size() != b.measured.y.size())
      node.fail("holds " + std::to_string(b.simulated.size()) + " values for " + std::to_string(b.measured.y.size()) +
                " measured");
  }

  void read_executor(Object& root) {
    Object o = root.section("executor", "how runs are computed");
    ExecutorSettings& e = study_.executor;
    e.kind = std::vector<std::string>{"local", "slurm"}[o.choice("kind", "an executor", {"local", "slurm"}, 0)];
    e.jobs = whole(o, "jobs", 1, 0);
    for (const Node& n : o.items("options", "options of sbatch")) e.slurm.push_back(n.text("an option of sbatch"));
    o.done();
  }

  Document& document_;
  Study study_;
};

/// The number that stands in the case: SI, or degrees where the key says so.
double case_value(const StudyParameter& p, const std::string& pointer, double value) {
  const bool in_degrees = pointer.size() > 4 && pointer.compare(pointer.size() - 4, 4, "_deg") == 0;
  if (in_degrees && p.unit == "deg") return value;
  return parse_unit(p.unit).factor * value;
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& observable_kinds() {
  static const std::vector<std::pair<std::string, std::string>> kinds = {
      {"mass-per-cycle", "mass of one cycle of the valve"},
      {"mass-after-cycles", "mass in the vessel after so many cycles"},
      {"load-cell", "signal of a load cell against time"},
      {"folded-flow", "flow against the rotor's angle"},
      {"hopper-discharge", "mass out of a hopper against time"},
      {"flow-rate", "mass per time"},
      {"drained-angle", "angle of repose left in a drained vessel"},
      {"static-angle", "angle of repose of a heap"},
      {"dynamic-angle", "angle of the surface in a rotating drum"},
      {"pile-profile", "height of a pile against place"},
      {"residue", "mass left behind"},
      {"bulk-density", "mass per volume of a bed"},
      {"tapped-density", "mass per volume of a tapped bed"},
      {"compressibility", "strain or density against stress"},
      {"wall-friction", "shear stress or angle on a wall against normal stress"},
      {"shear", "shear stress of a bed against normal stress"},
      {"fill-height", "height of a bed"},
      {"torque", "moment on a part"},
      {"other", "anything else"}};
  return kinds;
}

Study read_study(const std::string& path, const std::vector<std::string>& plugin_path) {
  const std::string text = read_text_file(path);
  if (!parse_json(text, path).is_object()) throw Error(Fault::settings, path + ": a study is one JSON object");
  Document document(text, path, {});
  Study study = StudyReader(document).read();
  study.text = text;
  study.executor.plugin_path = plugin_path;
  check_cases(study);
  return study;
}

double prior_mean(const StudyParameter& p) {
  return p.prior == StudyParameter::Prior::normal ? p.mean : 0.5 * (p.low + p.high);
}

double prior_sd(const StudyParameter& p) {
  return p.prior == StudyParameter::Prior::normal ? p.sd : (p.high - p.low) / std::sqrt(12.0);
}

double parameter_value(const StudyParameter& p, double standardised) {
  return std::clamp(prior_mean(p) + standardised * prior_sd(p), p.low, p.high);
}

const StudyCase& case_of(const Study& study, const std::string& name) {
  return *std::find_if(study.cases.begin(), study.cases.end(), [&](const StudyCase& c) { return c.name == name; });
}

RunRequest request_for(const Study& study, const StudyCase& which, const std::vector<double>& values,
                       std::uint64_t seed, bool reduced) {
  RunRequest out;
  out.case_path = reduced ? which.reduced : which.path;
  out.overrides = which.set;
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const StudyParameter& p = study.parameters[k];
    if (std::find(p.cases.begin(), p.cases.end(), which.name) == p.cases.end()) continue;
    for (const std::string& pointer : p.set)
      out.overrides.emplace_back(pointer, format_number(case_value(p, pointer, values[k])));
  }
  out.seed = seed;
  return out;
}

}  // namespace calx
