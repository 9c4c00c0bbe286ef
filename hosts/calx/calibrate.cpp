#include "calibrate.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "base/units.hpp"
#include "report/calibration_page.hpp"
#include "study/calibrate.hpp"
#include "study_command.hpp"

namespace calx {
namespace {

/// What a person wants to know first, on stdout.
void print_result(const Study& study, const Calibration& c) {
  std::printf("%-24s %12s %12s   %-25s %s\n", "parameter", "mean", "sd", "90 % interval", "sd / prior sd");
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const Posterior& p = c.parameters[k];
    const std::string& unit = study.parameters[k].unit;
    std::printf("%-24s %12.5g %12.3g   %-25s %.2f\n",
                (study.parameters[k].name + (unit == "1" ? "" : ", " + unit)).c_str(), p.mean, p.sd,
                (brief_quantity(p.q05, "1") + " to " + brief_quantity(p.q95, "1")).c_str(), p.identifiability);
  }
  for (const Confounded& f : c.confounded)
    std::printf("the data tell %s and %s only together (correlation %.2f)\n", study.parameters[f.first].name.c_str(),
                study.parameters[f.second].name.c_str(), f.correlation);
  for (std::size_t o = 0; o < study.observables.size(); ++o)
    std::printf("%s (%s): %s, z = %.2f\n", study.observables[o].name.c_str(),
                study.observables[o].use == StudyObservable::Use::fit ? "fit" : "held out",
                c.observables[o].agrees ? "agrees" : "does not agree", c.observables[o].z);
  for (const std::string& n : c.notes) std::printf("note: %s\n", n.c_str());
}

void calibrate_command(const StudyFlags& flags, bool json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  if (flags.only_schema()) return;
  StudySession session(flags, json, stop, catch_signals,
                       {"calibration.json", "cost.json", "runs.csv", "samples.csv", "material.json", "report.html"});
  const Calibration result = calibrate(session.study, *session.executor, session.sink);
  session.progress.end();
  write_calibration(session.out, session.study, result);
  print_result(session.study, result);
  if (!flags.no_report) session.progress.message("report: " + write_calibration_report(session.out));
}

}  // namespace

void add_calibrate_command(CLI::App& app, bool& json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  auto* command = app.add_subcommand("calibrate", "fit parameters to measured data, and say what the data can tell");
  const auto flags = std::make_shared<StudyFlags>();
  flags->add_to(*command, json);
  command->callback([flags, &json, &stop, catch_signals] { calibrate_command(*flags, json, stop, catch_signals); });
}

}  // namespace calx
