// child_runs.hpp: runs of cases as child processes of this program, a few at a time.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace calx {

struct ChildRun {
  std::string name;                    // for messages
  std::vector<std::string> arguments;  // after the program's name
  std::string messages;                // path of a file that takes what the run prints
};

struct ChildResult {
  int exit_code = 0;
  std::string error;  // last line it printed when the exit code is not 0
  double wall_seconds = 0;
};

/// Computes the runs in order, at most `jobs` at a time, and calls ended(index, result) after each. When *stop turns
/// true, or this process dies, running children get SIGINT, on which a run writes its checkpoint; then no further run
/// is begun. Throws Error(Fault::files) when a process cannot be started. [main]
void run_children(const std::vector<ChildRun>& runs, std::size_t jobs, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t, const ChildResult&)>& ended);

}  // namespace calx
