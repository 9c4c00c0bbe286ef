// launch_local.cpp: runs as child processes of one thread each. Children die with this process, however it ends.
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>

#include "base/error.hpp"
#include "study/launcher.hpp"

namespace calx {
namespace {

class LocalLauncher : public Launcher {
 public:
  LocalLauncher(const ExecutorSettings& settings, Ending ending)
      : settings_(settings), signal_(ending == Ending::at_once ? SIGKILL : SIGINT) {}
  ~LocalLauncher() override { stop(); }

  std::size_t jobs() const override {
    return settings_.jobs > 0 ? settings_.jobs : std::max(1u, std::thread::hardware_concurrency());
  }

  void start(const std::string& folder, const std::vector<std::string>& words) override {
    // Everything that allocates happens before the fork.
    std::vector<char*> arguments;
    for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
    arguments.push_back(nullptr);
    // The very program that is running, even when a new build has taken its place in the meantime.
    const std::string program = settings_.program.empty() ? "/proc/self/exe" : settings_.program;
    const std::string said = folder + "/" + kSaid;
    // As calx sets it for itself, by starting anew; a child needs not to.
    setenv("GOMP_SPINCOUNT", "10000", 0);
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0) throw Error(Fault::files, std::string("a run cannot be started: ") + std::strerror(errno));
    if (child == 0) {
      // Ctrl-C is for this process, which ends its runs itself.
      setpgid(0, 0);
      prctl(PR_SET_PDEATHSIG, signal_);
      if (getppid() != parent) _exit(127);
      const int out = open(said.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0666), in = open("/dev/null", O_RDONLY);
      if (out < 0 || in < 0) _exit(127);
      dup2(in, 0);
      dup2(out, 1);
      dup2(out, 2);
      execv(program.c_str(), arguments.data());
      _exit(127);
    }
    running_[child] = folder;
  }

  bool adopt(const std::string&) override { return false; }

  std::vector<Ended> wait() override {
    std::vector<Ended> out;
    for (auto it = running_.begin(); it != running_.end();) {
      int status = 0;
      if (waitpid(it->first, &status, WNOHANG) == 0) {
        ++it;
        continue;
      }
      Ended e;
      e.folder = it->second;
      if (WIFEXITED(status) && WEXITSTATUS(status) != 127) {
        e.code = WEXITSTATUS(status);
      } else {
        e.code = -1;
        e.lost = WIFEXITED(status) ? std::string("calx could not be started")
                                   : "was ended by signal " + std::to_string(WTERMSIG(status)) +
                                         (WTERMSIG(status) == SIGKILL ? " (out of memory?)" : "");
      }
      out.push_back(e);
      it = running_.erase(it);
    }
    if (out.empty() && !running_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return out;
  }

  void stop() override {
    for (const auto& r : running_) kill(r.first, signal_);
    for (const auto& r : running_) waitpid(r.first, nullptr, 0);
    running_.clear();
  }

 private:
  ExecutorSettings settings_;
  int signal_;
  std::map<pid_t, std::string> running_;
};

}  // namespace

std::unique_ptr<Launcher> make_local_launcher(const ExecutorSettings& settings, Ending ending) {
  return std::make_unique<LocalLauncher>(settings, ending);
}

}  // namespace calx
