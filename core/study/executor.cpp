// executor.cpp: batches of runs over a launcher, with the cache of finished runs.
// The cache holds a folder KEY for a finished run and KEY.part for one that is not; the rename between them is what
// makes a run finished, so that a killed study never takes half a run for a whole one.
#include "study/executor.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "io/io.hpp"
#include "study/launcher.hpp"
#include "study/resolve.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kFailed = "failed.txt";

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string time_text(double seconds) {
  if (seconds < 90) return std::to_string(static_cast<int>(seconds + 0.5)) + " s";
  if (seconds < 5400) return std::to_string(static_cast<int>(seconds / 60 + 0.5)) + " min";
  return std::to_string(static_cast<int>(seconds / 3600 + 0.5)) + " h";
}

/// The command line of a run of folder/input.json into that folder.
std::vector<std::string> run_command(const ExecutorSettings& settings, const std::string& folder) {
  std::vector<std::string> out{
      settings.program.empty() ? fs::read_symlink("/proc/self/exe").string() : settings.program,
      "run",
      folder + "/" + kInput,
      "-o",
      folder,
      "--threads",
      "1",
      "--device",
      "cpu",
      "--overwrite",
      "--quiet",
      "--no-report"};
  for (const std::string& path : settings.plugin_path) {
    out.push_back("--plugin-path");
    out.push_back(fs::absolute(path).string());
  }
  return out;
}

class CachedExecutor : public Executor {
 public:
  explicit CachedExecutor(const ExecutorSettings& settings) : settings_(settings) {
    if (settings.kind == "local")
      launcher_ = make_local_launcher(settings_, Ending::at_once);
    else if (settings.kind == "slurm")
      launcher_ = make_slurm_launcher(settings_);
    else
      throw Error(Fault::settings, "executor \"" + settings.kind + "\" is not known; must be \"local\" or \"slurm\"");
    std::error_code failed;
    fs::create_directories(settings_.cache, failed);
    if (failed) throw Error(Fault::files, settings_.cache + ": cannot be made: " + failed.message());
    lock();
    for (const auto& entry : fs::directory_iterator(settings_.cache)) {
      if (entry.path().extension() != ".part") continue;
      if (!launcher_->adopt(entry.path().string())) fs::remove_all(entry.path());
    }
  }
  ~CachedExecutor() override {
    launcher_->stop();
    if (lock_ >= 0) close(lock_);
  }

  std::vector<RunResult> run(const std::vector<RunRequest>& requests, const ProgressSink& sink) override {
    std::vector<std::string> keys;
    std::map<std::string, RunResult> results;
    std::vector<std::string> pending;
    std::map<std::string, std::string> texts;
    for (const RunRequest& request : requests) {
      const CaseFile file = resolve(request, settings_.plugin_path);
      keys.push_back(cache_key(file, settings_.plugin_path));
      const std::string& key = keys.back();
      if (request.may_be_refused) may_be_refused_.insert(key);
      if (results.count(key) || texts.count(key)) continue;
      if (fs::exists(folder(key))) {
        results[key] = finished(key, true);
      } else {
        texts[key] = file.resolved;
        pending.push_back(key);
      }
    }
    batch(pending, texts, results, sink);
    std::vector<RunResult> out;
    for (const std::string& key : keys) out.push_back(results[key]);
    return out;
  }

 private:
  std::string folder(const std::string& key) const { return settings_.cache + "/" + key; }
  std::string part(const std::string& key) const { return folder(key) + ".part"; }

  void lock() {
    const std::string path = settings_.cache + "/lock";
    lock_ = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (lock_ < 0) throw Error(Fault::files, path + ": cannot be written");
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw Error(Fault::files,
                  settings_.cache + ": another study works in this folder; wait for its end or choose another with -o");
  }

  void begin(const std::string& key, const std::string& text) {
    if (fs::exists(part(key))) return;  // adopted
    fs::create_directories(part(key));
    write_text_atomically(part(key) + "/" + kInput, text);
    launcher_->start(part(key), run_command(settings_, part(key)));
  }

  void batch(const std::vector<std::string>& pending, const std::map<std::string, std::string>& texts,
             std::map<std::string, RunResult>& results, const ProgressSink& sink) {
    const Clock::time_point start = Clock::now();
    std::size_t next = 0, running = 0, ended = 0;
    const std::size_t cached = results.size(), total = cached + pending.size();
    while (ended < pending.size()) {
      while (next < pending.size() && running < launcher_->jobs()) {
        begin(pending[next], texts.at(pending[next]));
        ++next, ++running;
      }
      if (sink.stop && sink.stop->load()) {
        launcher_->stop();
        throw Error(Fault::interrupted, "interrupted; finished runs are kept, the same command goes on");
      }
      for (const Ended& e : launcher_->wait()) {
        const std::string key = fs::path(e.folder).stem().string();
        if (texts.count(key) == 0) continue;  // adopted, but not asked for any more
        results[key] = finish(key, e);
        --running, ++ended;
      }
      if (!sink.progress) continue;
      StudyProgress p;
      p.done = cached + ended;
      p.total = total;
      p.running = running;
      if (ended > 0)
        p.seconds_left =
            seconds_since(start) / static_cast<double>(ended) * static_cast<double>(pending.size() - ended);
      p.text = std::to_string(p.done) + " of " + std::to_string(total) + " runs, " + std::to_string(running) +
               " running" + (cached > 0 ? ", " + std::to_string(cached) + " taken from earlier" : "") +
               (ended > 0 ? ", " + time_text(p.seconds_left) + " left" : "");
      sink.progress(p);
    }
  }

  RunResult finish(const std::string& key, const Ended& e) {
    const std::string said = last_said(part(key));
    if (e.code == 0 || (e.code == static_cast<int>(Fault::numerics) && stopped_by_itself(key))) {
      if (e.code != 0) write_text_atomically(part(key) + "/" + kFailed, said);
      // A finished run is read, never gone on with.
      for (const char* name : {"checkpoint.h5", "checkpoint.previous.h5"}) fs::remove(part(key) + "/" + name);
      fs::rename(part(key), folder(key));
      return finished(key, false);
    }
    const bool refused = e.code == static_cast<int>(Fault::settings) && may_be_refused_.count(key) > 0;
    if (!refused) end_study(e, said);
    RunResult out;
    out.error = e.code < 0 ? e.lost : said;
    // Gone, so that the run is begun anew when it is asked for again.
    fs::remove_all(part(key));
    return out;
  }

  /// What would fail in the same way for every run ends the study.
  void end_study(const Ended& e, const std::string& said) {
    for (const Fault fault : {Fault::usage, Fault::settings, Fault::plugin, Fault::files})
      if (e.code == static_cast<int>(fault)) {
        launcher_->stop();
        throw Error(fault == Fault::usage ? Fault::settings : fault, "a run of the study failed: " + said);
      }
  }

  /// The run went on until its numbers went wrong, so that it would again.
  bool stopped_by_itself(const std::string& key) const {
    const std::string path = part(key) + "/summary.json";
    if (!fs::exists(path)) return false;
    const auto summary = nlohmann::json::parse(read_text(path), nullptr, false);
    return summary.is_object() && summary.value("status", "") == "stopped";
  }

  RunResult finished(const std::string& key, bool cached) const {
    RunResult out;
    out.folder = folder(key);
    out.cached = cached;
    if (fs::exists(out.folder + "/" + kFailed)) out.error = read_text(out.folder + "/" + kFailed);
    const auto summary = nlohmann::json::parse(read_text(out.folder + "/summary.json"), nullptr, false);
    if (summary.is_object()) out.wall_seconds = summary.value("wall_seconds", 0.0);
    return out;
  }

  ExecutorSettings settings_;
  std::unique_ptr<Launcher> launcher_;
  std::set<std::string> may_be_refused_;  // keys
  int lock_ = -1;
};

}  // namespace

std::string last_said(const std::string& folder) {
  const std::string path = folder + "/" + kSaid;
  std::string text = fs::exists(path) ? read_text(path) : "";
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  text = text.substr(text.rfind('\n') + 1);
  return text.compare(0, 6, "calx: ") == 0 ? text.substr(6) : text;
}

std::unique_ptr<Executor> make_executor(const ExecutorSettings& settings) {
  return std::make_unique<CachedExecutor>(settings);
}

}  // namespace calx
