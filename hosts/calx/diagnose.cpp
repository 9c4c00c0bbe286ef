#include "diagnose.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "report/diagnosis_page.hpp"
#include "study/diagnose.hpp"
#include "study_command.hpp"

namespace calx {
namespace {

void diagnose_command(const StudyFlags& flags, bool json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  if (flags.only_schema()) return;
  StudySession session(flags, json, stop, catch_signals,
                       {"diagnosis.json", "cost.json", "runs.csv", "extension", "generic", "report.html"});
  const StudyDiagnosis result = diagnose_study(session.study, *session.executor, session.sink);
  session.progress.end();
  write_diagnosis(session.out, session.study, result);
  std::printf("%s", diagnosis_summary(session.study, result).c_str());
  if (!flags.no_report) session.progress.message("report: " + write_diagnosis_report(session.out));
}

}  // namespace

void add_diagnose_command(CLI::App& app, bool& json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  auto* command = app.add_subcommand(
      "diagnose", "show what a simulation gets wrong, name the cause, extend the model, measure the gain");
  const auto flags = std::make_shared<StudyFlags>();
  flags->add_to(*command, json);
  command->callback([flags, &json, &stop, catch_signals] { diagnose_command(*flags, json, stop, catch_signals); });
}

}  // namespace calx
