// run.cpp: the loop of a run and what it writes when.
#include "sim/run.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/sha256.hpp"
#include "base/units.hpp"
#include "io/io.hpp"
#include "sim/summary.hpp"
#include "sim/wall_clock.hpp"
#include "sim/whole_case.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Wall time between two summaries of a running run, s.
constexpr double kSummaryInterval = 5;

/// Steps between two looks at the wall clock.
constexpr std::uint64_t kWallClockSteps = 16;

/// Things done at multiples of an interval of simulated time, in the step that ends nearest to each. What is due
/// follows from the time alone, so that a resumed run does it in the same steps.
struct Clock {
  double every = 0;          // s; 0: never
  std::uint64_t number = 0;  // of the next multiple
  bool due(double t, double dt) const { return every > 0 && static_cast<double>(number) * every <= t + 0.5 * dt; }
  /// Everything up to time t is done, before a resume or now.
  void done(double t, double dt) {
    if (every > 0) number = std::max(number, static_cast<std::uint64_t>((t + 0.5 * dt) / every));
    while (due(t, dt)) ++number;
  }
};

bool has_checkpoint(const std::string& dir) {
  return fs::exists(dir + "/checkpoint.h5") || fs::exists(dir + "/checkpoint.previous.h5");
}

/// True when the folder holds something that a new run would throw away.
bool holds_run(const std::string& dir) {
  if (has_checkpoint(dir)) return true;
  if (!fs::exists(dir + "/summary.json")) return false;
  const Json summary = Json::parse(read_text(dir + "/summary.json"), nullptr, false);
  // A case that failed before its first step is corrected and run again.
  return !summary.is_object() || summary.value("steps", Json(1)) != Json(0);
}

/// Where two cases differ, as JSON pointers: "/time/end, /seed"; empty: nowhere.
std::string changed_places(const std::string& before, const std::string& now) {
  std::string out;
  std::size_t count = 0;
  constexpr std::size_t kShown = 5;
  for (const auto& change : Json::diff(Json::parse(before), Json::parse(now)))
    if (++count <= kShown) out += (out.empty() ? "" : ", ") + change["path"].get<std::string>();
  if (count > kShown) out += " and " + std::to_string(count - kShown) + " more";
  return out;
}

class Run {
 public:
  Run(const RunOptions& options, CaseFile file)
      : o_(options), dir_(run_folder(options)), resolved_(file.resolved), sim_(std::move(file), options.simulation) {}

  std::string go() {
    open();
    try {
      loop();
      facts_.status = "done";
      if (!at_end()) facts_.reason = "reached --until; go on with --resume";
      finish(true);
      write_summary();
    } catch (const Error& e) {
      facts_.status = e.fault() == Fault::interrupted ? "interrupted" : "stopped";
      facts_.reason = e.what();
      log_error(e.what());
      // What the run computed before is kept. A second failure hides neither the first nor the summary.
      attempt([&] { finish(e.fault() == Fault::interrupted); });
      attempt([&] { write_summary(); });
      close_log();
      throw Error(e.fault(), e.what() + last_checkpoint_text());
    }
    tell(closing_line());
    close_log();
    return dir_;
  }

 private:
  void open() {
    // Of building the world; a resume would drop them.
    const std::vector<std::string> first = sim_.take_messages();
    if (!o_.resume && !o_.overwrite && holds_run(dir_))
      throw Error(Fault::files, dir_ + ": already holds a run; use " +
                                    (has_checkpoint(dir_) ? "--resume to go on, " : "") +
                                    "--overwrite to start anew, or -o DIR");
    double at = -1;
    std::string note;
    if (o_.resume) {
      const auto state = read_checkpoint(dir_, &note);
      sim_.load(*state);
      at = checkpoint_time_ = sim_.time();
      const std::string changed = changed_places(state->get_text("case"), resolved_);
      if (!changed.empty())
        note += (note.empty() ? "" : "; ") + ("the case is not the one of the checkpoint any more: " + changed);
    } else if (o_.overwrite) {
      for (const char* name :
           {"frames", "series", "frames.pvd", "particles.h5", "checkpoint.h5", "checkpoint.previous.h5", "summary.json",
            "fields.json", "report.html", "run.log", "case.json"})
        fs::remove_all(dir_ + "/" + name);
    }
    std::error_code failed;
    fs::create_directories(dir_ + "/series", failed);
    if (failed) throw Error(Fault::files, dir_ + ": cannot be made: " + failed.message());
    LogSettings log;
    log.file = dir_ + "/run.log";
    log.append = o_.resume;
    open_log(log);
    for (const auto& m : first) say(m);
    if (!note.empty()) say(note);
    if (o_.resume) say("resumed at t = " + brief_quantity(at, "s"));
    write_text_atomically(dir_ + "/case.json", resolved_);
    facts_.case_sha256 = sha256(resolved_);
    facts_.started = utc_now();
    facts_.mixed = o_.simulation.mixed;
    facts_.threads = o_.simulation.threads > 0 ? o_.simulation.threads : omp_get_max_threads();
    const auto& out = sim_.settings().output;
    for (auto& s : sim_.sensors()) {
      series_.push_back(std::make_unique<SeriesFile>(dir_ + "/series/" + s->name() + ".csv", s->columns(), at));
      sample_.push_back({s->every(), 0});
      facts_.last.push_back(series_.back()->last_values());
    }
    sampled_at_.assign(series_.size(), -1);
    frames_clock_ = {out.frames_every, 0};
    checkpoint_clock_ = {out.checkpoint_every, 1};
    if (at >= 0) {
      for (auto& clock : sample_) clock.done(at, sim_.time_step());
      frames_clock_.done(at, sim_.time_step());
      checkpoint_clock_.done(at, sim_.time_step());
    }
    if (out.frames_every > 0) frames_ = std::make_unique<FrameWriter>(dir_, out.particles_h5, at);
    start_ = last_progress_ = last_checkpoint_ = seconds();
    // The first soon, so that a report of a run just started finds something.
    next_summary_ = start_ + 0.1 * kSummaryInterval;
    first_time_ = sim_.time();
    first_step_ = sim_.step_count();
  }

  void loop() {
    const auto& out = sim_.settings().output;
    const double dt = sim_.time_step();
    const double end = o_.until >= 0 ? std::min(o_.until, sim_.settings().time.end) : sim_.settings().time.end;
    while (!sim_.finished() && sim_.time() < end - 0.5 * dt) {
      const std::uint64_t steps = sim_.step(steps_to_look(end));
      particle_steps_ += static_cast<double>(steps * sim_.particle_count());
      const double t = sim_.time();
      for (auto& m : sim_.take_messages()) say(m);
      record(t, dt);
      if (frames_ && frames_clock_.due(t, dt)) {
        write_frame();
        frames_clock_.done(t, dt);
      }
      if (checkpoint_clock_.every > 0 && checkpoint_clock_.due(t, dt)) {
        save();
        checkpoint_clock_.done(t, dt);
      }
      if (o_.stop && o_.stop->load()) throw Error(Fault::interrupted, "interrupted at t = " + brief_quantity(t, "s"));
      // Reading the clock costs more than a small step.
      if (sim_.step_count() % kWallClockSteps != 0) continue;
      const double now = seconds();
      if (o_.progress && now - last_progress_ > 0.2) {
        report_progress(now, end);
        last_progress_ = now;
      }
      if (out.checkpoint_every_wall > 0 && now - last_checkpoint_ > out.checkpoint_every_wall) save();
      if (now > next_summary_) {
        facts_.status = "running";
        write_summary();
        next_summary_ = seconds() + kSummaryInterval;
      }
    }
  }

  /// Steps until something is due after one, or until the wall clock is read again.
  std::uint64_t steps_to_look(double end) const {
    const double dt = sim_.time_step();
    std::uint64_t steps = 1;
    const auto due = [&](double t) {
      const auto rings = [&](const Clock& c) { return c.due(t, dt); };
      return t >= end - 0.5 * dt || std::any_of(sample_.begin(), sample_.end(), rings) ||
             (frames_ && rings(frames_clock_)) || rings(checkpoint_clock_);
    };
    while ((sim_.step_count() + steps) % kWallClockSteps != 0 &&
           !due(static_cast<double>(sim_.step_count() + steps) * dt))
      ++steps;
    return steps;
  }

  void record(double t, double dt) {
    for (std::size_t k = 0; k < sim_.sensors().size(); ++k) {
      Sensor& s = *sim_.sensors()[k];
      const bool due = sample_[k].due(t, dt);
      if (!due && !s.row_due()) continue;
      write_row(k);
      if (due) sample_[k].done(t, dt);
    }
  }

  void write_row(std::size_t k) {
    facts_.last[k] = sim_.sensors()[k]->sample(sim_.world());
    series_[k]->write(sim_.time(), facts_.last[k]);
    sampled_at_[k] = sim_.time();
  }

  void write_frame() {
    frames_->write(sim_.world());
    frame_at_ = sim_.time();
  }

  bool at_end() const { return sim_.finished(); }

  void save() {
    write_checkpoint(dir_, [&](StateWriter& out) { sim_.save(out); });
    last_checkpoint_ = seconds();
    checkpoint_time_ = sim_.time();
  }

  void write_summary() {
    facts_.wall_seconds = seconds() - start_;
    facts_.rate = facts_.wall_seconds > 0 ? particle_steps_ / facts_.wall_seconds : 0;
    facts_.events.clear();
    for (const auto& e : sim_.settings().events)
      if (sim_.world().event_time(e.name) >= 0) facts_.events.emplace_back(e.name, sim_.world().event_time(e.name));
    write_text_atomically(dir_ + "/fields.json", fields_json(sim_));
    write_text_atomically(dir_ + "/summary.json", summary_json(sim_, facts_));
  }

  /// good: the state can be gone on from; after numbers went wrong the last checkpoint before stays.
  void finish(bool good) {
    const bool moved = sim_.step_count() > first_step_;
    // The end of the case gets a row of every sensor and a frame, and so does a failure a frame. A pause gets neither,
    // or the run gone on with would differ from one without a pause.
    if (moved && good && at_end())
      for (std::size_t k = 0; k < series_.size(); ++k)
        if (sampled_at_[k] < sim_.time()) write_row(k);
    if (moved && frames_ && (!good || at_end()) && frame_at_ < sim_.time()) write_frame();
    if (good) save();
  }

  template <typename Action>
  void attempt(Action action) {
    try {
      action();
    } catch (const Error& second) {
      log_error(second.what());
    }
  }

  void report_progress(double now, double end) {
    RunProgress p;
    p.time = sim_.time();
    p.end = end;
    p.share = (p.time - first_time_) / std::max(end - first_time_, 1e-300);
    p.particles = sim_.particle_count();
    p.particle_steps_per_second = particle_steps_ / std::max(now - start_, 1e-9);
    p.seconds_left = p.share > 0 ? (now - start_) * (1 - p.share) / p.share : 0;
    char text[200];
    std::snprintf(text, sizeof text, "t = %.4f of %.4g s  %3.0f %%  %zu particles", p.time, end, 100 * p.share,
                  p.particles);
    p.text = text;
    // Before, the time is that of the first lists, or of compiling for a device.
    if (p.share >= 0.002) {
      std::snprintf(text, sizeof text, "  %.2f M particle-steps/s  %s left", p.particle_steps_per_second * 1e-6,
                    clock_text(p.seconds_left).c_str());
      p.text += text;
    }
    if (sim_.settings().rest.on) p.text += "  " + std::to_string(sim_.counters().asleep) + " asleep";
    o_.progress(p);
  }

  std::string closing_line() const {
    return facts_.status + (facts_.reason.empty() ? "" : " (" + facts_.reason + ")") +
           ": t = " + brief_quantity(sim_.time(), "s") + ", " + std::to_string(sim_.step_count()) + " steps, " +
           std::to_string(sim_.particle_count()) + " particles, " + brief_quantity(facts_.wall_seconds, "s") +
           " of wall time, " + brief_quantity(facts_.rate * 1e-6, "1") + " M particle-steps/s";
  }

  void tell(const std::string& text) {
    log_info(text);
    if (o_.message) o_.message(text);
  }
  void say(const std::string& text) {
    facts_.notes.push_back(text);
    tell(text);
  }

  std::string last_checkpoint_text() const {
    if (sim_.step_count() == 0) return "";
    if (checkpoint_time_ < 0) return "; no checkpoint was written";
    return "; last checkpoint at t = " + brief_quantity(checkpoint_time_, "s") + ", go on with --resume";
  }

  RunOptions o_;
  std::string dir_, resolved_;
  Simulation sim_;
  RunFacts facts_;
  std::vector<std::unique_ptr<SeriesFile>> series_;
  std::vector<Clock> sample_;
  Clock frames_clock_, checkpoint_clock_;
  std::unique_ptr<FrameWriter> frames_;
  double start_ = 0, last_progress_ = 0, last_checkpoint_ = 0, checkpoint_time_ = -1, first_time_ = 0,
         next_summary_ = 0;
  std::vector<double> sampled_at_;  // time of the last row of each sensor, s
  double frame_at_ = -1;            // time of the last frame, s
  std::uint64_t first_step_ = 0;
  double particle_steps_ = 0;
};

}  // namespace

std::string run_folder(const RunOptions& options) {
  if (!options.out.empty()) return options.out;
  fs::path p(options.case_path);
  if (p.extension() == ".json") p.replace_extension();
  return p.string() + ".out";
}

std::string run_case(const RunOptions& options) { return Run(options, read_whole_case(options)).go(); }

}  // namespace calx
