// launcher.hpp: starts runs in folders and says when they have ended.
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
  /// Runs the words, calx and its arguments, for that folder, which exists; what it says goes to kSaid there.
  virtual void start(const std::string& folder, const std::vector<std::string>& words) = 0;
  /// True when a run started by an earlier process still goes in that folder, or has ended there; it is then watched as
  /// if this process had started it.
  virtual bool adopt(const std::string& folder) = 0;
  /// Those that ended since the last call; waits some milliseconds when there are none.
  virtual std::vector<Ended> wait() = 0;
  /// Ends all that is running.
  virtual void stop() = 0;
};

/// How stop() and the death of this process end a child: at once, or so that it writes its checkpoint first.
enum class Ending { at_once, with_checkpoint };

std::unique_ptr<Launcher> make_local_launcher(const ExecutorSettings& settings, Ending ending);
std::unique_ptr<Launcher> make_slurm_launcher(const ExecutorSettings& settings);

/// The last line that a run said in its folder, without the name of the program.
std::string last_said(const std::string& folder);

}  // namespace calx
