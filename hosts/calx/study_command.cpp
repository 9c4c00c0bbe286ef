#include "study_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "base/error.hpp"
#include "options.hpp"
#include "study/diagnose.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

std::string default_folder(const std::string& study) {
  fs::path p(study);
  if (p.extension() == ".json") p.replace_extension();
  return p.string() + ".out";
}

Study read(const StudyFlags& flags) {
  if (flags.study.empty()) throw Error(Fault::usage, "a study file is needed");
  Study study = read_study(flags.study, flags.plugin_path);
  if (flags.budget > 0) study.budget = flags.budget;
  if (flags.jobs > 0) study.executor.jobs = flags.jobs;
  if (!flags.executor.empty()) study.executor.kind = flags.executor;
  if (flags.seed >= 0) study.seed = static_cast<std::uint64_t>(flags.seed);
  return study;
}

}  // namespace

void StudyFlags::add_to(CLI::App& command, bool& json) {
  command.add_option("study", study, "study file (JSON)");
  command.add_option("-o,--out", out, "folder of the results (default: STUDY.out)");
  command.add_option("--budget", budget, "runs to spend; overrides the study")->check(whole_above_zero());
  command.add_option("--jobs", jobs, "runs at a time (default: cores)")->check(whole_above_zero());
  command.add_option("--executor", executor, "local or slurm; overrides the study")
      ->check(CLI::IsMember({"local", "slurm"}));
  command.add_option("--cache", cache, "folder of finished runs (default: runs in the folder of the results)");
  command.add_option("--seed", seed, "seed of all random choices; overrides the study")->check(whole_number());
  command.add_option("--plugin-path", plugin_path, "folder with plugins, searched first; repeatable");
  // A killed study goes on by itself; the option is there for those who look for it.
  command.add_flag("--resume", "go on with finished runs; always so, unless --overwrite");
  command.add_flag("--overwrite", overwrite, "forget earlier results and runs");
  command.add_flag("--quiet", quiet, "no progress");
  command.add_flag("--json", json, "progress as JSON lines on stderr");
  command.add_flag("--no-report", no_report, "do not write report.html");
  command.add_flag("--print-schema", print_schema, "print the JSON Schema of a study");
}

bool StudyFlags::only_schema() const {
  if (print_schema) std::printf("%s", study_schema().c_str());
  return print_schema;
}

StudySession::StudySession(const StudyFlags& flags, bool json, const std::atomic<bool>& stop, void (*catch_signals)(),
                           const std::vector<std::string>& results)
    : study(read(flags)),
      out(fs::absolute(flags.out.empty() ? default_folder(flags.study) : flags.out).string()),
      progress(flags.quiet, json) {
  study.executor.cache = flags.cache.empty() ? out + "/runs" : fs::absolute(flags.cache).string();
  if (flags.overwrite) {
    fs::remove_all(out + "/runs");
    for (const std::string& name : results) fs::remove_all(out + "/" + name);
  } else if (fs::exists(study.executor.cache)) {
    progress.message("finished runs of " + study.executor.cache + " are taken again; --overwrite starts anew");
  }
  std::error_code failed;
  fs::create_directories(out, failed);
  if (failed) throw Error(Fault::files, out + ": cannot be made: " + failed.message());
  prepare_generic_terms(study, out);
  catch_signals();
  sink.progress = [this](const StudyProgress& p) { progress.show(p); };
  sink.message = [this](const std::string& line) { progress.message(line); };
  sink.stop = &stop;
  executor = make_executor(study.executor);
}

}  // namespace calx
