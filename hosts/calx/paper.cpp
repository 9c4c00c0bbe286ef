// paper.cpp: which runs a rows file needs, which of them are there, and the page.
#include "paper.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "options.hpp"
#include "report/paper.hpp"
#include "report/paper_figures.hpp"
#include "study/launcher.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr char kRows[] = "examples/paper/rows.json";

std::atomic<bool> stop_requested{false};
void on_signal(int) {
  if (stop_requested.exchange(true)) _exit(130);
}

struct PaperOptions {
  std::string path, out, device;
  std::vector<std::string> rows, plugin_path;
  std::size_t seeds = std::numeric_limits<std::size_t>::max(), jobs = 0;
  int threads = 0;
  bool full = false, page_only = false, quiet = false;
};

/// One process at a time may compute runs in a folder; the kernel lets go of the lock when the process ends.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder) {
    fs::create_directories(folder);
    file_ = open((folder + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw Error(Fault::files, folder + ": cannot be written");
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      close(file_);
      throw Error(Fault::files, folder + ": another calx paper computes runs there; wait for it, or give another -o");
    }
  }
  ~FolderLock() { close(file_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_;
};

struct Wanted {
  const PaperRun* run;
  std::uint64_t seed;
  std::string folder;
  PaperRunState state;
};

/// Runs of the rows asked for. First seeds come first, so that every row has a figure early.
std::vector<Wanted> wanted_runs(const PaperRows& rows, const PaperOptions& o, int form) {
  std::vector<std::string> names;
  for (const PaperRow& r : rows.rows) names.push_back(r.name);
  for (const std::string& name : o.rows)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(Fault::usage,
                  "paper: --rows " + name + ": no such row in " + rows.file + "; " + did_you_mean(name, names));
  std::vector<const PaperRun*> needed;
  for (const PaperRow& row : rows.rows) {
    if (!o.rows.empty() && std::find(o.rows.begin(), o.rows.end(), row.name) == o.rows.end()) continue;
    for (const std::string& name : {row.figure.run, row.figure.minus_run}) {
      if (name.empty()) continue;
      const PaperRun* run = &paper_run(rows, name);
      if (!run->forms[form].case_path.empty() && std::find(needed.begin(), needed.end(), run) == needed.end())
        needed.push_back(run);
    }
  }
  std::vector<Wanted> out;
  std::size_t most = 0;
  for (const PaperRun* run : needed) most = std::max(most, std::min(o.seeds, run->seeds.size()));
  for (std::size_t k = 0; k < most; ++k)
    for (const PaperRun* run : needed) {
      if (k >= std::min(o.seeds, run->seeds.size())) continue;
      const std::string folder = paper_run_folder(o.out, *run, form, run->seeds[k]);
      out.push_back({run, run->seeds[k], folder, paper_run_state(folder, run->forms[form], run->seeds[k])});
    }
  return out;
}

std::vector<std::string> command_of(const Wanted& w, const PaperOptions& o, int form) {
  std::vector<std::string> words = {"calx",   "run",    w.run->forms[form].case_path, "-o",
                                    w.folder, "--seed", std::to_string(w.seed)};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.push_back(option);
    words.push_back(value);
  };
  for (const auto& [pointer, value] : w.run->forms[form].set) add("--set", pointer + "=" + value);
  // A run that was interrupted goes on; anything else that is in the way is replaced.
  const bool resume = w.state == PaperRunState::unfinished && fs::exists(w.folder + "/checkpoint.h5");
  words.push_back(resume ? "--resume" : "--overwrite");
  if (o.threads > 0) add("--threads", std::to_string(o.threads));
  if (!o.device.empty()) add("--device", o.device);
  for (const std::string& folder : o.plugin_path) add("--plugin-path", folder);
  return words;
}

std::string minutes(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, seconds < 100 ? "%.0f s" : "%.0f min", seconds < 100 ? seconds : seconds / 60);
  return text;
}

/// Keeps jobs runs going until all have ended, or a signal asks for the end; running ones then write their checkpoints.
template <class Report>
void run_all(const std::vector<Wanted>& runs, const PaperOptions& o, int form, const Report& ended) {
  ExecutorSettings settings;
  settings.jobs = o.jobs;
  const auto launcher = make_local_launcher(settings, Ending::with_checkpoint);
  std::map<std::string, std::pair<const Wanted*, Clock::time_point>> running;
  std::size_t next = 0;
  while (!stop_requested && (next < runs.size() || !running.empty())) {
    for (; next < runs.size() && running.size() < launcher->jobs(); ++next) {
      fs::create_directories(runs[next].folder);
      launcher->start(runs[next].folder, command_of(runs[next], o, form));
      running[runs[next].folder] = {&runs[next], Clock::now()};
    }
    for (const Ended& e : launcher->wait()) {
      const auto [which, begin] = running.at(e.folder);
      running.erase(e.folder);
      ended(*which, e, std::chrono::duration<double>(Clock::now() - begin).count());
    }
  }
}

void compute(const PaperRows& rows, const PaperOptions& o, int form) {
  const FolderLock lock(o.out);
  std::vector<Wanted> wanted = wanted_runs(rows, o, form);
  const std::size_t all = wanted.size();
  wanted.erase(
      std::remove_if(wanted.begin(), wanted.end(), [](const Wanted& w) { return w.state == PaperRunState::done; }),
      wanted.end());
  const auto say = [&](const std::string& line) {
    if (!o.quiet) std::fprintf(stderr, "%s\n", line.c_str());
  };
  say(std::to_string(all - wanted.size()) + " of " + std::to_string(all) + " runs are finished and kept; " +
      std::to_string(wanted.size()) + " to compute, " + std::to_string(o.jobs) + " at a time");
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::size_t done = 0;
  double seconds = 0;
  std::string failures;
  int worst = 0;
  run_all(wanted, o, form, [&](const Wanted& w, const Ended& e, double wall_seconds) {
    ++done;
    seconds += wall_seconds;
    const double left =
        seconds / static_cast<double>(done) * static_cast<double>(wanted.size() - done) / static_cast<double>(o.jobs);
    const std::string name = w.run->name + ", seed " + std::to_string(w.seed);
    const std::string error = e.code == 0 ? "" : e.code < 0 ? e.lost : last_said(w.folder);
    say("[" + std::to_string(done) + "/" + std::to_string(wanted.size()) + "] " + name + ": " +
        (e.code == 0 ? "done in " + minutes(wall_seconds) : error) +
        (done < wanted.size() ? "; about " + minutes(left) + " left" : ""));
    if (e.code != 0 && e.code != static_cast<int>(Fault::interrupted)) {
      failures += "\n  " + name + ": " + error;
      if (worst == 0) worst = e.code;
    }
    write_paper(rows, o.seeds, o.out);
  });
  if (stop_requested) throw Error(Fault::interrupted, "paper: interrupted; the same command goes on");
  if (worst != 0) {
    const bool known = worst >= 2 && worst <= 6;
    throw Error(known ? static_cast<Fault>(worst) : Fault::numerics, "paper: not every run ended well:" + failures);
  }
}

void paper(PaperOptions o) {
  if (o.path.empty()) {
    if (!fs::exists(kRows))
      throw Error(Fault::usage,
                  std::string("paper: ") + kRows + " is not below the working directory; give a rows file");
    o.path = kRows;
  }
  if (o.out.empty()) o.out = (fs::path(o.path).parent_path() / "paper.out").string();
  const int form = o.full ? paper_full : paper_reduced;
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  // Small runs do not gain from threads; a full one takes the machine.
  if (o.jobs == 0) o.jobs = o.full ? 1 : cores;
  if (o.threads == 0 && !o.full) o.threads = 1;
  const PaperRows rows = read_paper_rows(o.path);
  if (!o.page_only) {
    try {
      compute(rows, o, form);
    } catch (const Error&) {
      // The page says what is there and what is not; the error that ended the runs is what counts.
      write_paper(rows, o.seeds, o.out);
      throw;
    }
  }
  std::printf("%s\n", write_paper(rows, o.seeds, o.out).c_str());
}

}  // namespace

void add_paper_command(CLI::App& app) {
  auto* command = app.add_subcommand("paper", "run the rows of a publication and set them beside its figures");
  auto o = std::make_shared<PaperOptions>();
  command->add_option("rows-file", o->path, std::string("rows file (default: ") + kRows + ")");
  command->add_option("-o,--out", o->out, "folder of runs and page (default: paper.out beside the rows file)");
  command->add_option("--rows", o->rows, "run only for the row of this name; repeatable")->allow_extra_args(false);
  command->add_option("--seeds", o->seeds, "the first N seeds of each run (default: all)")->check(whole_above_zero());
  command->add_flag("--full", o->full, "run the full forms: days on processors, meant for a GPU");
  command->add_option("--jobs", o->jobs, "runs at a time (default: one a core; full: 1)")->check(whole_above_zero());
  command->add_option("--threads", o->threads, "threads of a run (default: 1; full: all cores)")
      ->check(whole_above_zero());
  command->add_option("--device", o->device, "as for calx run");
  command->add_option("--plugin-path", o->plugin_path, "folder with plugins, searched first; repeatable")
      ->allow_extra_args(false);
  command->add_flag("--page-only", o->page_only, "write the page of what is there, run nothing");
  command->add_flag("--quiet", o->quiet, "no progress");
  command->callback([o] { paper(*o); });
}

}  // namespace calx
