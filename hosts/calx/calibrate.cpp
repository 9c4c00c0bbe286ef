#include "calibrate.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "base/units.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "report/calibration_page.hpp"
#include "study/calibrate.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

struct Flags {
  std::string study, out, executor, cache;
  std::size_t budget = 0, jobs = 0;
  long long seed = -1;
  std::vector<std::string> plugin_path;
  bool overwrite = false, quiet = false, no_report = false, print_schema = false;
};

std::string default_folder(const std::string& study) {
  fs::path p(study);
  if (p.extension() == ".json") p.replace_extension();
  return p.string() + ".out";
}

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

void calibrate_command(const Flags& flags, bool json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  Study study = read_study(flags.study, flags.plugin_path);
  if (flags.budget > 0) study.budget = flags.budget;
  if (flags.jobs > 0) study.executor.jobs = flags.jobs;
  if (!flags.executor.empty()) study.executor.kind = flags.executor;
  if (flags.seed >= 0) study.seed = static_cast<std::uint64_t>(flags.seed);
  const std::string out = fs::absolute(flags.out.empty() ? default_folder(flags.study) : flags.out).string();
  study.executor.cache = flags.cache.empty() ? out + "/runs" : fs::absolute(flags.cache).string();
  Progress progress(flags.quiet, json);
  if (flags.overwrite) {
    for (const char* name :
         {"runs", "calibration.json", "cost.json", "runs.csv", "samples.csv", "material.json", "report.html"})
      fs::remove_all(out + "/" + name);
  } else if (fs::exists(study.executor.cache)) {
    progress.message("finished runs of " + study.executor.cache + " are taken again; --overwrite starts anew");
  }
  std::error_code failed;
  fs::create_directories(out, failed);
  if (failed) throw Error(Fault::files, out + ": cannot be made: " + failed.message());
  catch_signals();
  ProgressSink sink;
  sink.progress = [&](const StudyProgress& p) { progress.show(p); };
  sink.message = [&](const std::string& line) { progress.message(line); };
  sink.stop = &stop;
  const std::unique_ptr<Executor> executor = make_executor(study.executor);
  const Calibration result = calibrate(study, *executor, sink);
  progress.end();
  write_calibration(out, study, result);
  print_result(study, result);
  if (!flags.no_report) progress.message("report: " + write_calibration_report(out));
}

}  // namespace

void add_calibrate_command(CLI::App& app, bool& json, const std::atomic<bool>& stop, void (*catch_signals)()) {
  auto* command = app.add_subcommand("calibrate", "fit parameters to measured data, and say what the data can tell");
  const auto flags = std::make_shared<Flags>();
  command->add_option("study", flags->study, "study file (JSON)");
  command->add_option("-o,--out", flags->out, "folder of the results (default: STUDY.out)");
  command->add_option("--budget", flags->budget, "runs to spend; overrides the study")->check(whole_above_zero());
  command->add_option("--jobs", flags->jobs, "runs at a time (default: cores)")->check(whole_above_zero());
  command->add_option("--executor", flags->executor, "local or slurm; overrides the study")
      ->check(CLI::IsMember({"local", "slurm"}));
  command->add_option("--cache", flags->cache, "folder of finished runs (default: runs in the folder of the results)");
  command->add_option("--seed", flags->seed, "seed of all random choices; overrides the study")->check(whole_number());
  command->add_option("--plugin-path", flags->plugin_path, "folder with plugins, searched first; repeatable");
  // A killed study goes on by itself; the option is there for those who look for it.
  command->add_flag("--resume", "go on with finished runs; always so, unless --overwrite");
  command->add_flag("--overwrite", flags->overwrite, "forget earlier results and runs");
  command->add_flag("--quiet", flags->quiet, "no progress");
  command->add_flag("--json", json, "progress as JSON lines on stderr");
  command->add_flag("--no-report", flags->no_report, "do not write report.html");
  command->add_flag("--print-schema", flags->print_schema, "print the JSON Schema of a study");
  command->callback([flags, &json, &stop, catch_signals] {
    if (flags->print_schema) {
      std::printf("%s", study_schema().c_str());
      return;
    }
    if (flags->study.empty()) throw Error(Fault::usage, "calibrate: a study file is needed");
    calibrate_command(*flags, json, stop, catch_signals);
  });
}

}  // namespace calx
