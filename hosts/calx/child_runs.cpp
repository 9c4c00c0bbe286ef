#include "child_runs.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>

#include "base/error.hpp"

namespace calx {
namespace {

using Clock = std::chrono::steady_clock;

struct Running {
  std::size_t index = 0;
  Clock::time_point begin;
};

std::string last_line(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  const std::string prefix = "calx: ";
  return last.compare(0, prefix.size(), prefix) == 0 ? last.substr(prefix.size()) : last;
}

pid_t begin(const ChildRun& run) {
  // All that needs memory is done before fork.
  std::vector<std::string> words = {"calx"};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(&w[0]);
  argv.push_back(nullptr);
  const int out = open(run.messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0) throw Error(Fault::files, run.messages + ": cannot be written: " + std::strerror(errno));
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    // So that no run goes on unseen after this process was killed, be it before the child could ask for the signal.
    prctl(PR_SET_PDEATHSIG, SIGINT);
    if (getppid() != parent) _exit(127);
    // Ctrl-C reaches the children through this process only, once.
    setpgid(0, 0);
    dup2(in, 0);
    dup2(out, 1);
    dup2(out, 2);
    execv("/proc/self/exe", argv.data());
    _exit(127);
  }
  const int failed = errno;
  close(in);
  close(out);
  if (child < 0) throw Error(Fault::files, std::string("cannot start a run: ") + std::strerror(failed));
  return child;
}

}  // namespace

void run_children(const std::vector<ChildRun>& runs, std::size_t jobs, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t, const ChildResult&)>& ended) {
  std::map<pid_t, Running> running;
  std::size_t next = 0;
  bool told = false;
  while (!running.empty() || (next < runs.size() && !stop)) {
    while (!stop && next < runs.size() && running.size() < jobs) {
      running[begin(runs[next])] = {next, Clock::now()};
      ++next;
    }
    if (stop && !told) {
      for (const auto& child : running) kill(child.first, SIGINT);
      told = true;
    }
    int status = 0;
    const pid_t child = waitpid(-1, &status, WNOHANG);
    const auto at = running.find(child);
    if (at == running.end()) {
      usleep(20000);
      continue;
    }
    ChildResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.wall_seconds = std::chrono::duration<double>(Clock::now() - at->second.begin).count();
    const std::size_t index = at->second.index;
    running.erase(at);
    if (result.exit_code != 0) {
      result.error = last_line(runs[index].messages);
      if (result.error.empty()) result.error = "ended with code " + std::to_string(result.exit_code);
    }
    ended(index, result);
  }
}

}  // namespace calx
