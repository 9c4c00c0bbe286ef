// child.hpp: runs a piece of work in a child process with a time limit, so that foreign code which crashes, ends the
// process or never returns harms the child alone. Costs about a millisecond, for the work itself comes on top.
#pragma once
#include <functional>
#include <string>

namespace calx {

struct ChildOutcome {
  enum class End { answered, exited, crashed, late, not_started } end = End::not_started;
  std::string answer;  // what the work returned; answered only
  std::string output;  // what was written to stdout and stderr meanwhile
  int number = 0;      // exit status, signal, or errno
  double limit = 0;    // s

  bool answered() const { return end == End::answered; }
  /// The rest of a sentence about who did the work: "crashed with SIGSEGV (invalid memory access)".
  std::string text() const;
};

/// Forks; the child runs work and hands back its answer. An exception that leaves work ends the child with a crash.
/// limit: wall time, s; beyond it the child is killed. Threads of this process do not exist in the child. [main]
ChildOutcome run_in_child(const std::function<std::string()>& work, double limit);

}  // namespace calx
