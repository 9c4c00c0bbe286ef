// run.hpp: a whole run with its folder: series, frames, checkpoints, summary, progress.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace calx {

struct RunOptions {
  std::string case_path;
  std::string out;  // empty: the case's path without .json, with .out
  std::vector<std::pair<std::string, std::string>> overrides;
  SimulationOptions simulation;
  double until = -1;  // s; negative: to the end of the case
  bool resume = false, overwrite = false;
  /// Set by a signal handler: the run writes a checkpoint and ends with Fault::interrupted.
  const std::atomic<bool>* stop = nullptr;
  /// Called a few times a second with one line of progress; empty: none.
  std::function<void(const std::string& line)> progress;
  /// Events and notes, as they happen.
  std::function<void(const std::string& line)> message;
};

/// The folder a run of that case writes to.
std::string run_folder(const RunOptions& options);

/// Runs the case. Returns the folder. Throws Error; whatever was written before stays, and summary.json says how the
/// run ended ("done", "interrupted", "stopped").
std::string run_case(const RunOptions& options);

/// What `calx check` prints: materials, limits of the time step, particles, memory, cost, device plan, plugins.
std::string check_case(const RunOptions& options);

}  // namespace calx
