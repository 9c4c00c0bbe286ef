#include "plugin/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

namespace calx {
namespace {

using Clock = std::chrono::steady_clock;

const char* signal_text(int number) {
  switch (number) {
    case SIGSEGV:
      return "SIGSEGV (invalid memory access)";
    case SIGBUS:
      return "SIGBUS (invalid memory access)";
    case SIGFPE:
      return "SIGFPE (division by zero, or a floating-point trap)";
    case SIGILL:
      return "SIGILL (an instruction this processor does not have)";
    case SIGABRT:
      return "SIGABRT (abort, a failed assertion, or an exception that crossed the boundary)";
    case SIGTERM:
      return "SIGTERM";
    case SIGKILL:
      return "SIGKILL (perhaps out of memory)";
    default:
      return nullptr;
  }
}

void write_all(int to, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t n = ::write(to, bytes, count);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    bytes += n;
    count -= static_cast<std::size_t>(n);
  }
}

/// The last byte of an answer, so that a child that ends while it writes is not taken for one that finished.
constexpr char kEnd = '\x04';

[[noreturn]] void be_the_child(const std::function<std::string()>& work, int answer, int output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none = {0, 0};
  setrlimit(RLIMIT_CORE, &none);
  // Handlers of the program, such as those of a test framework, are not for the child.
  for (int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM}) signal(number, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing >= 0) dup2(nothing, 0);
  if (output >= 0) {
    dup2(output, 1);
    dup2(output, 2);
  }
  const std::string text = [&]() noexcept { return work(); }();
  std::fflush(nullptr);
  write_all(answer, text.data(), text.size());
  write_all(answer, &kEnd, 1);
  _exit(0);
}

std::string content(int file) {
  std::string out;
  char buffer[4096];
  for (off_t at = 0;;) {
    const ssize_t n = ::pread(file, buffer, sizeof buffer, at);
    if (n <= 0) return out;
    out.append(buffer, static_cast<std::size_t>(n));
    at += n;
  }
}

}  // namespace

std::string ChildOutcome::text() const {
  switch (end) {
    case End::answered:
      return "finished";
    case End::exited:
      return "ended the process with exit status " + std::to_string(number);
    case End::crashed: {
      const char* name = signal_text(number);
      return "crashed with " + (name ? std::string(name) : "signal " + std::to_string(number));
    }
    case End::late: {
      char seconds[32];
      std::snprintf(seconds, sizeof seconds, "%g", limit);
      return std::string("did not come back within ") + seconds + " s";
    }
    case End::not_started:
      break;
  }
  return std::string("could not be tried in a process of its own: ") + std::strerror(number);
}

ChildOutcome run_in_child(const std::function<std::string()>& work, double limit) {
  ChildOutcome outcome;
  outcome.limit = limit;
  int answer[2];
  if (pipe2(answer, O_CLOEXEC) != 0) {
    outcome.number = errno;
    return outcome;
  }
  const int output = memfd_create("calx-output", MFD_CLOEXEC);
  std::fflush(nullptr);  // else the child would write what waits in this process's buffers once more
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit));
  const pid_t child = fork();
  if (child == 0) {
    ::close(answer[0]);
    be_the_child(work, answer[1], output);
  }
  outcome.number = errno;
  ::close(answer[1]);
  int status = 0;
  bool gone = child < 0;
  bool open = child > 0;
  const auto left_ms = [&] {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    return left < 0 ? 0 : static_cast<int>(left);
  };
  while (open) {
    pollfd wait = {answer[0], POLLIN, 0};
    const int ready = poll(&wait, 1, left_ms());
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) break;
    char buffer[4096];
    const ssize_t n = ::read(answer[0], buffer, sizeof buffer);
    if (n > 0) outcome.answer.append(buffer, static_cast<std::size_t>(n));
    open = n > 0 || (n < 0 && errno == EINTR);
  }
  // The pipe is closed when the child ends; one that closed it by itself gets what is left of its time.
  while (!gone) {
    const pid_t seen = waitpid(child, &status, WNOHANG);
    gone = seen == child || (seen < 0 && errno != EINTR);
    if (gone) break;
    if (left_ms() == 0) {
      kill(child, SIGKILL);
      while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
      outcome.end = ChildOutcome::End::late;
      break;
    }
    usleep(500);
  }
  ::close(answer[0]);
  if (output >= 0) {
    outcome.output = content(output);
    ::close(output);
  }
  if (child < 0 || outcome.end == ChildOutcome::End::late) return outcome;
  if (!outcome.answer.empty() && outcome.answer.back() == kEnd) {
    outcome.answer.pop_back();
    outcome.end = ChildOutcome::End::answered;
  } else if (WIFSIGNALED(status)) {
    outcome.end = ChildOutcome::End::crashed;
    outcome.number = WTERMSIG(status);
  } else {
    outcome.end = ChildOutcome::End::exited;
    outcome.number = WEXITSTATUS(status);
  }
  return outcome;
}

}  // namespace calx
