// main.cpp: the command line: options to calls, errors to messages and exit codes.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "base/version.hpp"
#include "bench.hpp"
#include "calibrate.hpp"
#include "compare.hpp"
#include "diagnose.hpp"
#include "last_words.hpp"
#include "law.hpp"
#include "options.hpp"
#include "paper.hpp"
#include "plugin/tables.hpp"
#include "plugin_commands.hpp"
#include "progress.hpp"
#include "report/calibration_page.hpp"
#include "report/diagnosis_page.hpp"
#include "report/report.hpp"
#include "sim/run.hpp"

namespace {

std::atomic<bool> stop_requested{false};
void on_signal(int) {
  // A second Ctrl-C ends the program at once.
  if (stop_requested.exchange(true)) _exit(130);
}

void catch_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

struct CaseFlags {
  std::vector<std::string> set, plugin_path;
  calx::RunOptions run;
  std::string device = "auto", precision = "double", arithmetic = "exact";
  long long seed = -1;
  bool quiet = false, json = false, no_report = false, require_pins = false, safe_mode = false;

  void add_common(CLI::App& app) {
    app.add_option("case", run.case_path, "case file (JSON)")->required();
    app.add_option("--set", set, "override, repeatable: /json/pointer=value");
    app.add_option("--threads", run.simulation.threads, "threads (default: all cores)")
        ->check(calx::whole_above_zero());
    app.add_option("--device", device,
                   "auto, cpu, opencl[:i] or cuda[:i]; host: the text of devices as plain loops, for debuggers");
    app.add_option("--precision", precision, "double, or mixed: pair contacts in single precision");
    app.add_option("--arithmetic", arithmetic,
                   "exact, or fast: devices may contract a * b + c, to other last digits than the processor's");
    app.add_option("--seed", seed, "seed of all random choices; overrides the case")->check(calx::whole_number());
    app.add_option("--plugin-path", plugin_path, "folder with plugins, searched first; repeatable");
    app.add_flag("--safe-mode", safe_mode,
                 "load only plugins that came with Calx: none of yours, none beside the case");
    app.add_flag("--require-pins", require_pins, "load only plugins whose SHA-256 the case gives");
  }
  calx::RunOptions options() {
    if (precision != "double" && precision != "mixed")
      throw calx::Error(calx::Fault::usage, "--precision " + precision + ": expected \"double\" or \"mixed\"");
    if (safe_mode && !plugin_path.empty())
      throw calx::Error(calx::Fault::usage,
                        "--safe-mode excludes --plugin-path: it loads only plugins that came with Calx");
    run.simulation.device = device;
    if (arithmetic != "exact" && arithmetic != "fast")
      throw calx::Error(calx::Fault::usage, "--arithmetic " + arithmetic + ": expected \"exact\" or \"fast\"");
    run.simulation.fast = arithmetic == "fast";
    run.simulation.mixed = precision == "mixed";
    for (const auto& s : set) run.overrides.push_back(calx::split_override(s, "/time/end=2.0"));
    if (seed >= 0) run.overrides.emplace_back("/seed", std::to_string(seed));
    run.simulation.plugin_path = plugin_path;
    run.simulation.require_pins = require_pins;
    run.simulation.safe_mode = safe_mode;
    return run;
  }
};

int run(CaseFlags& flags) {
  calx::RunOptions options = flags.options();
  calx::Progress progress(flags.quiet, flags.json);
  options.progress = [&](const calx::RunProgress& p) { progress.show(p); };
  options.message = [&](const std::string& line) { progress.message(line); };
  options.stop = &stop_requested;
  catch_signals();
  // A full disk shows as an error of the write, not as the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  const std::string folder = calx::run_folder(options);
  auto report = [&] {
    if (flags.no_report || !std::filesystem::exists(folder + "/summary.json")) return;
    progress.message("report: " + calx::write_report(folder));
  };
  try {
    const calx::LastWords last_words(folder);
    calx::run_case(options);
  } catch (const calx::Error& e) {
    progress.end();
    // A report of what was computed; the error that ended the run is what counts.
    if (e.fault() == calx::Fault::numerics || e.fault() == calx::Fault::interrupted) try {
        report();
      } catch (const calx::Error&) {
      }
    throw;
  }
  progress.end();
  report();
  return 0;
}

/// An error on stderr, as text or as a JSON line.
int fail(bool json, int code, const std::string& message) {
  if (json)
    std::fprintf(stderr, "{\"event\": \"error\", \"exit_code\": %d, \"message\": %s}\n", code,
                 calx::json_string(message).c_str());
  else
    std::fprintf(stderr, "calx: %s\n", message.c_str());
  return code;
}

int guarded(CLI::App& app, const bool& json, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    return fail(json, static_cast<int>(calx::Fault::usage), calx::usage_text(app, e, argc, argv));
  } catch (const calx::Error& e) {
    return fail(json, e.exit_code(), e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    return fail(json, static_cast<int>(calx::Fault::files), e.what());
  } catch (const std::bad_alloc&) {
    return fail(json, static_cast<int>(calx::Fault::numerics),
                "out of memory; the case needs more than this machine has (see calx check)");
  } catch (const std::exception& e) {
    return fail(json, 1, std::string("a fault of calx itself, please report it: ") + e.what());
  }
}

/// Where the documents lie, for the end of calx --help.
std::string documents() {
  std::error_code bad;
  const std::string installed = calx::program_prefix() + "/share/doc/calx";
  if (std::filesystem::is_directory(installed, bad)) return "Documents: " + installed;
  return "Documents: README.md, docs and abi/README.md of the source tree";
}

}  // namespace

int main(int argc, char** argv) {
  // GNU OpenMP spins for milliseconds at a barrier, which starves the very thread it waits for when the machine has
  // other work (measured: four times slower with one busy neighbour). It reads this variable only while the program
  // loads.
  if (!std::getenv("GOMP_SPINCOUNT") && !std::getenv("OMP_WAIT_POLICY")) {
    setenv("GOMP_SPINCOUNT", "10000", 1);
    execv("/proc/self/exe", argv);
  }
  CLI::App app{"Calx: how powder fills a canister, by discrete elements", "calx"};
  app.require_subcommand(1);
  app.footer(documents());
  app.set_version_flag("--version", std::string("calx ") + calx::version() + " (" + calx::git_revision() + "), ABI " +
                                        calx::abi_version());

  CaseFlags run_flags, check_flags;
  auto* run_command = app.add_subcommand("run", "run a case and write its report");
  run_flags.add_common(*run_command);
  run_command->add_option("-o,--out", run_flags.run.out, "folder of the results (default: CASE.out)");
  run_command->add_option("--until", run_flags.run.until, "stop at this simulated time, s")
      ->check(calx::zero_or_more());
  run_command->add_flag("--resume", run_flags.run.resume, "go on from the last checkpoint");
  run_command->add_flag("--overwrite", run_flags.run.overwrite, "replace an earlier run in the folder");
  run_command->add_flag("--quiet", run_flags.quiet, "no progress");
  run_command->add_flag("--json", run_flags.json, "progress as JSON lines on stderr");
  run_command->add_flag("--no-report", run_flags.no_report, "do not write report.html");
  run_command->callback([&] { run(run_flags); });

  auto* check_command = app.add_subcommand("check", "validate a case and show what a run would cost");
  bool print_schema = false, sensors = false;
  check_flags.add_common(*check_command);
  check_command->get_option("case")->required(false);
  check_command->add_flag("--print-schema", print_schema, "print the JSON Schema of a case");
  check_command->add_flag("--sensors", sensors, "list the built-in kinds of sensors with their keys");
  check_command->callback([&] {
    if (print_schema) {
      std::printf("%s\n", calx::case_schema().c_str());
      return;
    }
    if (sensors) {
      std::fputs(calx::sensor_kinds_text().c_str(), stdout);
      return;
    }
    if (check_flags.run.case_path.empty()) throw calx::Error(calx::Fault::usage, "check: a case file is needed");
    std::fputs(calx::check_case(check_flags.options()).c_str(), stdout);
  });

  auto* report_command = app.add_subcommand("report", "write report.html of a finished or running run");
  std::string report_folder;
  report_command->add_option("dir", report_folder, "folder of the run")->required();
  report_command->callback([&] {
    namespace fs = std::filesystem;
    if (fs::exists(report_folder + "/calibration.json")) {
      std::printf("%s\n", calx::write_calibration_report(report_folder).c_str());
      return;
    }
    if (fs::exists(report_folder + "/diagnosis.json")) {
      std::printf("%s\n", calx::write_diagnosis_report(report_folder).c_str());
      return;
    }
    if (fs::is_directory(report_folder) && !fs::exists(report_folder + "/case.json") &&
        !fs::exists(report_folder + "/summary.json"))
      throw calx::Error(calx::Fault::files, report_folder +
                                                ": holds no run, neither case.json nor summary.json; give the "
                                                "folder of a run (-o of calx run)");
    std::printf("%s\n", calx::write_report(report_folder).c_str());
  });

  calx::add_plugin_command(app);
  calx::add_compare_command(app);
  calx::add_bench_command(app);
  calx::add_law_command(app);
  calx::add_calibrate_command(app, run_flags.json, stop_requested, catch_signals);
  calx::add_diagnose_command(app, run_flags.json, stop_requested, catch_signals);
  calx::add_paper_command(app);
  return guarded(app, run_flags.json, argc, argv);
}
