// launcher.hpp: starts runs in folders and says when they have ended. Private to study/.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "study/executor.hpp"

namespace calx {

/// A run that has ended. code: the exit code of calx; negative: it left none, and lost says why.
struct Ended {
  std::string folder;
  int code = 0;
  std::string lost;
};

/// Name of the case inside of a run's folder that a launcher runs, and of the file that takes what calx says.
constexpr const char* kInput = "input.json";
constexpr const char* kSaid = "said.txt";

class Launcher {
 public:
  virtual ~Launcher() = default;
  /// How many runs to keep going at a time.
  virtual std::size_t jobs() const = 0;
  /// Runs folder/input.json into that folder.
  virtual void start(const std::string& folder) = 0;
  /// True when a run started by an earlier process still goes in that folder, or has ended there; it is then watched as
  /// if this process had started it.
  virtual bool adopt(const std::string& folder) = 0;
  /// Those that ended since the last call; waits some milliseconds when there are none.
  virtual std::vector<Ended> wait() = 0;
  /// Ends all that is running.
  virtual void stop() = 0;
};

std::unique_ptr<Launcher> make_local_launcher(const ExecutorSettings& settings);
std::unique_ptr<Launcher> make_slurm_launcher(const ExecutorSettings& settings);

/// The command line of a run: program, "run", ...
std::vector<std::string> run_command(const ExecutorSettings& settings, const std::string& folder);

}  // namespace calx
