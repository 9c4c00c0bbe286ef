// calibration_files.cpp: what a calibration leaves on disk. calibration.json holds nothing that depends on how many
// jobs ran or on what was cached, so that a repeated or resumed study writes the same bytes; cost.json holds that.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/units.hpp"
#include "base/version.hpp"
#include "io/io.hpp"
#include "study/calibrate.hpp"
#include "study/csv_cell.hpp"
#include "study/resolve.hpp"

namespace calx {
namespace {

using Json = nlohmann::ordered_json;

double target_sd(const StudyObservable& o, std::size_t k) {
  return o.measured.sd[k] / std::sqrt(static_cast<double>(o.measured.repeats));
}

std::string told(double identifiability) {
  return identifiability < 0.5 ? "found" : identifiability < 0.8 ? "weakly" : "not told by the data";
}

Json parameters_json(const Study& study, const Calibration& c) {
  Json out = Json::array();
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const StudyParameter& p = study.parameters[k];
    const Posterior& q = c.parameters[k];
    Json prior = p.prior == StudyParameter::Prior::uniform ? Json("uniform")
                                                           : Json{{"normal", {{"mean", p.mean}, {"sd", p.sd}}}};
    out.push_back({{"name", p.name},
                   {"unit", p.unit},
                   {"range", {p.low, p.high}},
                   {"prior", prior},
                   {"mean", q.mean},
                   {"sd", q.sd},
                   {"q05", q.q05},
                   {"q50", q.q50},
                   {"q95", q.q95},
                   {"prior_sd", q.prior_sd},
                   {"identifiability", q.identifiability},
                   {"told", told(q.identifiability)},
                   {"set", p.set}});
  }
  return out;
}

Json observables_json(const Study& study, const Calibration& c) {
  Json out = Json::array();
  for (std::size_t o = 0; o < study.observables.size(); ++o) {
    const StudyObservable& b = study.observables[o];
    const PredictiveCheck& check = c.observables[o];
    std::vector<double> error;
    for (std::size_t k = 0; k < b.measured.y.size(); ++k) error.push_back(target_sd(b, k));
    out.push_back({{"name", b.name},
                   {"kind", b.kind},
                   {"case", b.case_name},
                   {"use", b.use == StudyObservable::Use::fit ? "fit" : "hold-out"},
                   {"unit", b.unit},
                   {"against", b.against},
                   {"x", b.measured.x},
                   {"measured", b.measured.y},
                   {"measured_sd", error},
                   {"repeats", b.measured.repeats},
                   {"tolerance", b.tolerance},
                   {"predicted", {{"mean", check.mean}, {"sd", check.sd}, {"q05", check.q05}, {"q95", check.q95}}},
                   {"confirmed", {{"mean", check.confirmed}, {"sd", check.confirmed_sd}}},
                   {"z", check.z},
                   {"agrees", check.agrees}});
  }
  return out;
}

Json emulators_json(const Study& study, const Calibration& c) {
  Json out = Json::array();
  for (std::size_t o = 0; o < study.observables.size(); ++o) {
    const EmulatorCheck& e = c.emulators[o];
    out.push_back(
        {{"observable", study.observables[o].name},
         {"components", e.components},
         {"noise_sd", e.noise_sd},
         {"share_of_variance", e.share},
         {"leave_one_out",
          {{"mean_square", e.mean_square}, {"simulated", e.seen}, {"predicted", e.predicted}, {"sd", e.sd}}}});
  }
  return out;
}

Json waves_json(const Study& study, const Calibration& c) {
  Json out = Json::array();
  for (const Wave& w : c.waves) {
    Json plausible = Json::object();
    for (std::size_t k = 0; k < study.parameters.size(); ++k)
      plausible[study.parameters[k].name] = {w.low[k], w.high[k]};
    out.push_back({{"places", w.places},
                   {"runs", w.runs},
                   {"reduced", w.reduced},
                   {"plausible_share", w.plausible_share},
                   {"plausible", plausible}});
  }
  return out;
}

std::size_t failed_runs(const Calibration& c) {
  return static_cast<std::size_t>(
      std::count_if(c.runs.begin(), c.runs.end(), [](const RunRow& r) { return !r.error.empty(); }));
}

std::string calibration_json(const Study& study, const Calibration& c) {
  Json j;
  j["calx_calibration"] = 1;
  j["title"] = study.title;
  j["study"] = {{"file", std::filesystem::path(study.file).filename().string()}, {"sha256", sha256(study.text)}};
  j["calx"] = std::string(version()) + " " + git_revision();
  j["seed"] = study.seed;
  j["parameters"] = parameters_json(study, c);
  Json rows = Json::array();
  for (Eigen::Index k = 0; k < c.correlation.rows(); ++k) {
    Json row = Json::array();
    for (Eigen::Index m = 0; m < c.correlation.cols(); ++m) row.push_back(c.correlation(k, m));
    rows.push_back(row);
  }
  j["correlations"] = rows;
  j["confounded"] = Json::array();
  for (const Confounded& f : c.confounded)
    j["confounded"].push_back({{"parameters", {study.parameters[f.first].name, study.parameters[f.second].name}},
                               {"correlation", f.correlation}});
  j["observables"] = observables_json(study, c);
  j["emulators"] = emulators_json(study, c);
  j["waves"] = waves_json(study, c);
  j["runs"] = {{"budget", study.budget}, {"spent", c.runs.size()}, {"failed", failed_runs(c)}, {"seeds", study.seeds}};
  j["sampler"] = {{"draws", c.samples.rows()}, {"acceptance", c.acceptance}, {"effective_draws", c.effective}};
  j["assumptions"] = study.assumptions;
  j["notes"] = c.notes;
  return j.dump(2) + "\n";
}

std::string cost_json(const Study& study, const Calibration& c) {
  StudyCost cost;
  for (const RunRow& r : c.runs) cost.add(r);
  return cost.json(study.executor.kind);
}

std::string runs_csv(const Study& study, const Calibration& c) {
  std::string out = "wave,place,case,reduced,seed,cached,wall_s,folder,error";
  for (const StudyParameter& p : study.parameters) out += "," + csv_cell(p.name);
  out += "\n";
  for (const RunRow& r : c.runs) {
    out += std::to_string(r.wave) + "," + std::to_string(r.place) + "," + csv_cell(r.case_name) + "," +
           (r.reduced ? "1," : "0,") + std::to_string(r.seed) + "," + (r.cached ? "1," : "0,") +
           format_number(r.wall_seconds) + "," + std::filesystem::path(r.folder).filename().string() + "," +
           csv_cell(r.error);
    for (const double v : r.values) out += "," + format_number(v);
    out += "\n";
  }
  return out;
}

std::string samples_csv(const Study& study, const Calibration& c) {
  std::string out;
  for (const StudyParameter& p : study.parameters) out += csv_cell(p.name) + ",";
  out += "log_density\n";
  for (Eigen::Index k = 0; k < c.samples.rows(); ++k) {
    for (Eigen::Index j = 0; j < c.samples.cols(); ++j) out += format_number(c.samples(k, j)) + ",";
    out += format_number(c.log_density(k)) + "\n";
  }
  return out;
}

/// The case that takes most of the parameters; the first of several.
const StudyCase& main_case(const Study& study) {
  const StudyCase* best = nullptr;
  std::ptrdiff_t most = -1;
  for (const StudyCase& c : study.cases) {
    const auto count = std::count_if(study.parameters.begin(), study.parameters.end(), [&](const StudyParameter& p) {
      return std::find(p.cases.begin(), p.cases.end(), c.name) != p.cases.end();
    });
    if (count > most) best = &c, most = count;
  }
  return *best;
}

/// The sections that the parameters stand in, whole: lists of a case cannot be merged entry by entry.
std::string material_json(const Study& study, const Calibration& c) {
  std::vector<double> mean;
  for (const Posterior& p : c.parameters) mean.push_back(p.mean);
  const StudyCase& from = main_case(study);
  const Json whole =
      Json::parse(resolve(request_for(study, from, mean, study.seed), study.executor.plugin_path).resolved);
  std::set<std::string> sections{"materials", "contacts"};
  for (const StudyParameter& p : study.parameters)
    for (const std::string& pointer : p.set) sections.insert(pointer.substr(1, pointer.find('/', 1) - 1));
  Json out;
  out["calx"] = 1;
  for (const auto& item : whole.items())
    if (sections.count(item.key())) out[item.key()] = item.value();
  Json assumed = Json::array();
  for (const std::string& a : study.assumptions) assumed.push_back(a);
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const StudyParameter& p = study.parameters[k];
    assumed.push_back(p.name + " = " + brief_quantity(mean[k], p.unit) + " +- " +
                      brief_quantity(c.parameters[k].sd, p.unit) + ": calibrated by study \"" + study.title +
                      "\", case \"" + from.name + "\"; valid for these grains and these tests");
  }
  out["assumptions"] = assumed;
  return out.dump(2) + "\n";
}

}  // namespace

void write_calibration(const std::string& folder, const Study& study, const Calibration& result) {
  write_text_atomically(folder + "/samples.csv", samples_csv(study, result));
  write_text_atomically(folder + "/runs.csv", runs_csv(study, result));
  write_text_atomically(folder + "/material.json", material_json(study, result));
  write_text_atomically(folder + "/cost.json", cost_json(study, result));
  // Last, for it says that the calibration is done.
  write_text_atomically(folder + "/calibration.json", calibration_json(study, result));
}

}  // namespace calx
