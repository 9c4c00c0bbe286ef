#include "last_words.hpp"

#include <signal.h>
#include <unistd.h>

#include <cstdlib>

namespace calx {
namespace {

// A handler of signals may only look at memory that is there already.
volatile sig_atomic_t armed = 0;
pid_t armed_process = 0;
std::string crashed_text, exited_text;
char stack[1 << 16];
constexpr int kSignals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

void say(const std::string& text) {
  if (::write(2, text.data(), text.size()) < 0) return;
}

void on_crash(int number) {
  if (armed) say(crashed_text);
  signal(number, SIG_DFL);
  raise(number);
}

// Not in a child that tries a plugin for the first time: there the parent tells it.
void on_exit_of_process() {
  if (!armed || getpid() != armed_process) return;
  say(exited_text);
  _exit(4);
}

}  // namespace

LastWords::LastWords(const std::string& folder) {
  const std::string after =
      "; what was computed is in " + folder +
      ", and --resume goes on from its last checkpoint. calx plugin check PATH tells which plugin "
      "of the case does not keep its promises, and --safe-mode runs without those that did not come with calx\n";
  crashed_text = "\ncalx: the process crashed in the middle of a run, in a plugin or in calx itself" + after;
  exited_text = "\ncalx: a plugin ended the process in the middle of a run, which no plugin may do" + after;
  static const int registered = std::atexit(on_exit_of_process);
  (void)registered;
  armed_process = getpid();
  // A stack of its own, for a crash may be that the stack is full.
  stack_t own = {};
  own.ss_sp = stack;
  own.ss_size = sizeof stack;
  sigaltstack(&own, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  for (const int number : kSignals) sigaction(number, &action, nullptr);
  armed = 1;
}

LastWords::~LastWords() {
  armed = 0;
  for (const int number : kSignals) signal(number, SIG_DFL);
}

}  // namespace calx
