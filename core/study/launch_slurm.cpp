// launch_slurm.cpp: runs as jobs of Slurm (sbatch, squeue, sacct, scancel). The cache stands on a file system that the
// nodes share. Jobs outlive a killed study; the next one finds them by the number in their folder and waits for them.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "base/error.hpp"
#include "io/io.hpp"
#include "study/launcher.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJob = "job.txt";
constexpr const char* kCode = "exit_code.txt";

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// What a command wrote to stdout and stderr; its status, -1 when it could not be started.
struct Answer {
  std::string text;
  int status = -1;
};
Answer ask(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& w : words) line += quoted(w) + " ";
  Answer out;
  std::FILE* pipe = popen((line + "2>&1").c_str(), "r");
  if (!pipe) return out;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) out.text.append(buffer, n);
  out.status = pclose(pipe);
  while (!out.text.empty() && out.text.back() == '\n') out.text.pop_back();
  return out;
}

class SlurmLauncher : public Launcher {
 public:
  explicit SlurmLauncher(const ExecutorSettings& settings) : settings_(settings) {
    const Answer version = ask({"sbatch", "--version"});
    if (version.status != 0)
      throw Error(Fault::settings, "executor \"slurm\": sbatch cannot be run (" + version.text +
                                       "); install Slurm's client programs or use \"local\"");
  }

  std::size_t jobs() const override { return settings_.jobs > 0 ? settings_.jobs : 100; }

  void start(const std::string& folder, const std::vector<std::string>& words) override {
    std::string script = "#!/bin/sh\n";
    for (const std::string& w : words) script += quoted(w) + " ";
    const std::string code = folder + "/" + kCode;
    script += "> " + quoted(folder + "/" + kSaid) + " 2>&1\necho $? > " + quoted(code + ".new") + "\nmv " +
              quoted(code + ".new") + " " + quoted(code) + "\n";
    write_text_atomically(folder + "/job.sh", script);
    std::vector<std::string> command{
        "sbatch",   "--parsable",         "--job-name=calx", "--ntasks=1", "--cpus-per-task=1",
        "--output", folder + "/slurm.txt"};
    command.insert(command.end(), settings_.slurm.begin(), settings_.slurm.end());
    command.push_back(folder + "/job.sh");
    const Answer answer = ask(command);
    if (answer.status != 0) {
      std::string why = answer.text;
      std::replace(why.begin(), why.end(), '\n', ' ');
      throw Error(Fault::files, "sbatch refused a run: " + why);
    }
    // "12" or "12;cluster", after warnings if any.
    std::string id = answer.text.substr(answer.text.rfind('\n') + 1);
    id = id.substr(0, id.find(';'));
    write_text_atomically(folder + "/" + kJob, id);
    running_[folder] = {id, 0};
  }

  bool adopt(const std::string& folder) override {
    if (!fs::exists(folder + "/" + kJob)) return false;
    const std::string id = read_text(folder + "/" + kJob);
    if (!fs::exists(folder + "/" + kCode) && queued().count(id) == 0) return false;
    running_[folder] = {id, 0};
    return true;
  }

  std::vector<Ended> wait() override {
    std::vector<Ended> out;
    const bool look = ++waits_ % 10 == 0;
    const std::set<std::string> there = look ? queued() : std::set<std::string>();
    for (auto it = running_.begin(); it != running_.end();) {
      const std::string code = it->first + "/" + kCode;
      Job& job = it->second;
      // A job that left the queue without a code may still have it on its way through the shared file system.
      if (look && !queue_lost_ && there.count(job.id) == 0) ++job.missed;
      if (fs::exists(code)) {
        out.push_back({it->first, std::atoi(read_text(code).c_str()), ""});
      } else if (job.missed >= 5) {
        out.push_back({it->first, -1, "job " + job.id + " ended as " + state(job.id) + " without a result"});
      } else {
        ++it;
        continue;
      }
      it = running_.erase(it);
    }
    if (out.empty() && !running_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return out;
  }

  void stop() override {
    std::vector<std::string> words{"scancel"};
    for (const auto& r : running_) words.push_back(r.second.id);
    if (words.size() > 1) ask(words);
    running_.clear();
  }

 private:
  struct Job {
    std::string id;
    int missed = 0;  // looks at the queue that did not find it
  };

  std::set<std::string> queued() {
    const Answer answer = ask({"squeue", "--noheader", "--format=%i"});
    queue_lost_ = answer.status != 0;
    std::set<std::string> out;
    std::istringstream lines(answer.text);
    for (std::string line; std::getline(lines, line);) out.insert(line);
    return out;
  }

  std::string state(const std::string& id) const {
    const Answer answer = ask({"sacct", "--noheader", "--parsable2", "--allocations", "--format=State", "--jobs", id});
    return answer.status == 0 && !answer.text.empty() ? answer.text : "unknown (no accounting)";
  }

  ExecutorSettings settings_;
  std::map<std::string, Job> running_;  // by folder
  std::size_t waits_ = 0;
  bool queue_lost_ = false;  // squeue did not answer last time
};

}  // namespace

std::unique_ptr<Launcher> make_slurm_launcher(const ExecutorSettings& settings) {
  return std::make_unique<SlurmLauncher>(settings);
}

}  // namespace calx
