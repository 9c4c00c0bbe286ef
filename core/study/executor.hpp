// executor.hpp: runs of cases for a study: who computes them is behind one interface, and finished runs are kept by the
// hash of everything they depend on. A study asks for some 10 to 300 runs of seconds to hours each.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace calx {

/// One run of a case.
struct RunRequest {
  std::string case_path;                                       // absolute
  std::vector<std::string> patches;                            // JSON merge patches (RFC 7396), applied in order
  std::vector<std::pair<std::string, std::string>> overrides;  // JSON pointer -> JSON value, applied after patches
  std::uint64_t seed = 1;
  bool may_be_refused = false;  // the case may turn out to be impossible, which says nothing of the other runs
};

struct RunResult {
  std::string folder;       // of the finished run; empty when it failed before it had one
  std::string error;        // why the run failed, as calx run said it; empty: done
  bool cached = false;      // taken from the cache, nothing was computed
  double wall_seconds = 0;  // of the run, also when cached
};

/// How far a batch of runs is.
struct StudyProgress {
  std::size_t done = 0, total = 0, running = 0;  // runs
  double seconds_left = 0;                       // wall time, from the runs finished so far; 0: not known yet
  std::string text;                              // the same in one line
};

/// Where an executor says how it goes, and where it learns that it should stop. Members may be empty.
struct ProgressSink {
  std::function<void(const StudyProgress&)> progress;
  std::function<void(const std::string& line)> message;
  /// Set by a signal handler: running runs are ended and run() throws Error(Fault::interrupted).
  const std::atomic<bool>* stop = nullptr;
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Results in the order of the requests, whatever the order in which runs end; equal requests are computed once. A
  /// run that fails by itself (blow-up, lost particle) gives a result with an error, and so does one that may be
  /// refused and is. Throws Error(Fault::settings) or Error(Fault::plugin) for any other case that cannot run at all,
  /// Error(Fault::files), Error(Fault::interrupted). [main]
  virtual std::vector<RunResult> run(const std::vector<RunRequest>& requests, const ProgressSink& sink) = 0;
};

struct ExecutorSettings {
  std::string kind = "local";            // or "slurm"
  std::size_t jobs = 0;                  // runs at a time; 0: local: cores, slurm: 100
  std::string cache;                     // folder of finished runs; made when missing
  std::string program;                   // the calx that computes; empty: the one that is running
  std::vector<std::string> plugin_path;  // as --plugin-path
  std::vector<std::string> slurm;        // further options of sbatch: "--partition=short", "--time=60"
};

/// An executor that keeps finished runs in settings.cache, one folder per key. Throws Error(Fault::settings) for an
/// unknown kind, Error(Fault::files) when the cache cannot be made or another process uses it.
std::unique_ptr<Executor> make_executor(const ExecutorSettings& settings);

}  // namespace calx
