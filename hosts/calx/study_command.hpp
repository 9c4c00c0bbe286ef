// study_command.hpp: what commands that run a study have in common: options, the folder of results, progress, executor.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "progress.hpp"
#include "study/study.hpp"

namespace CLI {
class App;
}
namespace calx {

struct StudyFlags {
  std::string study, out, executor, cache;
  std::size_t budget = 0, jobs = 0;
  long long seed = -1;
  std::vector<std::string> plugin_path;
  bool overwrite = false, quiet = false, no_report = false, print_schema = false;

  void add_to(CLI::App& command, bool& json);
  /// Prints the schema of a study if that is all the user asks for.
  bool only_schema() const;
};

/// A study read with its flags applied, and everything it needs to run.
class StudySession {
 public:
  /// results: files and folders of earlier results, which --overwrite removes. Throws what read_study and make_executor
  /// throw, and Error(Fault::files) when the folder of results cannot be made.
  StudySession(const StudyFlags& flags, bool json, const std::atomic<bool>& stop, void (*catch_signals)(),
               const std::vector<std::string>& results);

  Study study;
  std::string out;  // folder of the results, absolute
  Progress progress;
  ProgressSink sink;
  std::unique_ptr<Executor> executor;
};

}  // namespace calx
