// diagnosis_files.cpp: what a diagnosis leaves on disk. diagnosis.json holds nothing that depends on how many jobs ran
// or on what was cached; cost.json and runs.csv hold that.
#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/units.hpp"
#include "config/document.hpp"
#include "io/io.hpp"
#include "study/csv_cell.hpp"
#include "study/diagnose.hpp"
#include "study/diagnosis_text.hpp"
#include "study/generic_terms.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

/// What is put into the cases: the effects named, or a generic term that was accepted.
struct Extension {
  std::vector<Dose> doses;
  std::vector<double> values;  // of the parameters
  std::string sentence;
};

Extension extension_of(const Study& study, const StudyDiagnosis& d) {
  Extension out;
  for (std::size_t k = 0; k < d.diagnosis.named.size(); ++k)
    out.doses.push_back({&d.library.candidates[d.kept[d.diagnosis.named[k]]], d.amplitudes[k]});
  out.sentence = diagnosis_sentence(study, d);
  const bool generic = d.generic.accepted;
  if (generic) out.doses = {{&d.library.candidates[d.generic.tried[0].candidate], d.generic.amplitude}};
  const infer::Vector& u = generic ? d.generic.u : d.u_after;
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    out.values.push_back(parameter_value(study.parameters[k], u[static_cast<Eigen::Index>(k)]));
  return out;
}

/// The case as it stands, with the nuisance parameters found and the extension. Sections that change stand whole, for
/// lists of a case cannot be merged entry by entry.
std::string extension_text(const Study& study, const Extension& extension, std::size_t case_number,
                           const std::string& folder) {
  const StudyCase& which = study.cases[case_number];
  std::string names;
  for (const Dose& dose : extension.doses) names += (names.empty() ? "" : " and ") + dose.candidate->info.id;
  const RunRequest request = dosed_request(study, case_number, extension.values, study.seed, extension.doses, false);
  const Document document(read_text_file(which.path), which.path, request.overrides);
  Json out;
  out["calx"] = 1;
  out["title"] = document.root().value("title", fs::path(which.path).stem().string()) + ", with " + names;
  out["extends"] = fs::path(which.path).lexically_relative(folder).string();
  out["relative_to"] = fs::path(document.folder()).lexically_relative(folder).string();
  for (const auto& o : request.overrides) {
    const std::string section = o.first.substr(1, o.first.find('/', 1) - 1);
    out[section] = document.root()[section];
  }
  Json assumptions = document.root().value("assumptions", Json::array());
  assumptions.push_back(extension.sentence + " Fitted by calx diagnose to the data of study \"" + study.title +
                        "\"; valid for the conditions of these data.");
  out["assumptions"] = assumptions;
  return out.dump(2) + "\n";
}

std::string cost_json(const Study& study, const StudyDiagnosis& d) {
  StudyCost cost;
  for (const DosedRun& r : d.ledger.runs) cost.add(r);
  return cost.json(study.executor.kind);
}

std::string runs_csv(const Study& study, const StudyDiagnosis& d) {
  std::string out = "stage,case,reduced,seed,effects,cached,wall_s,folder,error";
  for (const StudyParameter& p : study.parameters) out += "," + csv_cell(p.name);
  out += "\n";
  for (const DosedRun& r : d.ledger.runs) {
    out += csv_cell(r.stage) + "," + csv_cell(r.case_name) + (r.reduced ? ",1," : ",0,") + std::to_string(r.seed) +
           "," + csv_cell(r.doses) + (r.cached ? ",1," : ",0,") + format_number(r.wall_seconds) + "," +
           fs::path(r.folder).filename().string() + "," + csv_cell(r.error);
    for (const double v : r.values) out += "," + format_number(v);
    out += "\n";
  }
  return out;
}

}  // namespace

void write_diagnosis(const std::string& folder, const Study& study, const StudyDiagnosis& d) {
  std::vector<std::pair<std::string, std::string>> extensions;
  std::error_code ignored;
  fs::remove_all(folder + "/extension", ignored);
  const Extension extension = extension_of(study, d);
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const bool acts = std::any_of(extension.doses.begin(), extension.doses.end(),
                                  [&](const Dose& dose) { return static_cast<bool>(dose.candidate->cases[k]); });
    if (!acts) continue;
    fs::create_directories(folder + "/extension");
    const std::string name = "extension/" + study.cases[k].name + ".json";
    write_text_atomically(folder + "/" + name, extension_text(study, extension, k, folder + "/extension"));
    extensions.emplace_back(study.cases[k].name, name);
  }
  // The law text stands beside the cases that use it, so that they run wherever the folder goes.
  if (d.generic.accepted)
    for (const GenericTerm& term : read_generic_terms(study))
      if (term.id() == extension.doses[0].candidate->info.id) write_generic_plugins(folder + "/extension", {term});
  write_text_atomically(folder + "/runs.csv", runs_csv(study, d));
  write_text_atomically(folder + "/cost.json", cost_json(study, d));
  // Last, for it says that the diagnosis is done.
  write_text_atomically(folder + "/diagnosis.json", diagnosis_json(study, d, extensions));
}

}  // namespace calx
