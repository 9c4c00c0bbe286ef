// run.cpp: the loop of a run and what it writes when.
#include "sim/run.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/sha256.hpp"
#include "base/units.hpp"
#include "io/io.hpp"
#include "sim/summary.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string clock_text(double s) {
  char text[40];
  const long whole = std::lround(s);
  if (whole >= 86400)
    std::snprintf(text, sizeof text, "%ld d %02ld h", whole / 86400, whole % 86400 / 3600);
  else if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

std::string utc_now() {
  const std::time_t t = std::time(nullptr);
  char text[32];
  std::tm parts{};
  gmtime_r(&t, &parts);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

/// Things done at multiples of an interval of simulated time. The next one follows from the time alone, so a resumed
/// run goes on where it stood.
struct Clock {
  double every = 0;
  double next = 0;
  void resume(double t) { next = every > 0 ? (std::floor(t / every + 1e-9) + 1) * every : 1e300; }
  bool due(double t, double dt) const { return every > 0 && t >= next - 0.5 * dt; }
  void done(double t, double dt) {
    while (next <= t + 0.5 * dt) next += every;
  }
};

class Run {
 public:
  Run(const RunOptions& options, CaseFile file)
      : o_(options), dir_(run_folder(options)), resolved_(file.resolved), sim_(std::move(file), options.simulation) {}

  std::string go() {
    open();
    try {
      loop();
      facts_.status = sim_.finished() || o_.until >= 0 ? "done" : "interrupted";
      finish(true);
    } catch (const Error& e) {
      facts_.status = e.fault() == Fault::interrupted ? "interrupted" : "stopped";
      facts_.reason = e.what();
      log_error(e.what());
      // What the run computed before is kept; a second failure must not hide the first.
      try {
        finish(e.fault() == Fault::interrupted);
      } catch (const Error& second) {
        log_error(second.what());
      }
      close_log();
      throw Error(e.fault(), e.what() + last_checkpoint_text());
    }
    close_log();
    if (facts_.status == "interrupted") throw Error(Fault::interrupted, "interrupted" + last_checkpoint_text());
    return dir_;
  }

 private:
  void open() {
    const bool held = fs::exists(dir_ + "/summary.json") || fs::exists(dir_ + "/checkpoint.h5");
    if (held && !o_.resume && !o_.overwrite)
      throw Error(Fault::files,
                  dir_ + ": already holds a run; use --resume to go on, --overwrite to start anew, or -o DIR");
    if (o_.overwrite && !o_.resume) {
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
    double at = -1;
    if (o_.resume) {
      std::string note;
      const auto state = read_checkpoint(dir_, &note);
      if (!note.empty()) say(note);
      sim_.load(*state);
      at = sim_.time();
      say("resumed at t = " + brief_quantity(at, "s"));
    }
    write_text_atomically(dir_ + "/case.json", resolved_);
    facts_.case_sha256 = sha256(resolved_);
    facts_.started = utc_now();
    facts_.threads = o_.simulation.threads > 0 ? o_.simulation.threads : omp_get_max_threads();
    const auto& out = sim_.settings().output;
    for (auto& s : sim_.sensors()) {
      series_.push_back(std::make_unique<SeriesFile>(dir_ + "/series/" + s->name() + ".csv", s->columns(), at));
      sample_.push_back({s->every(), 0});
      if (at >= 0) sample_.back().resume(at);
      facts_.last.emplace_back();
    }
    frames_clock_ = {out.frames_every, 0};
    checkpoint_clock_ = {out.checkpoint_every, out.checkpoint_every};
    if (at >= 0) {
      frames_clock_.resume(at);
      checkpoint_clock_.resume(at);
    }
    if (out.frames_every > 0) frames_ = std::make_unique<FrameWriter>(dir_, out.particles_h5, at);
    start_ = last_progress_ = last_checkpoint_ = seconds();
  }

  void loop() {
    const auto& out = sim_.settings().output;
    const double dt = sim_.time_step();
    const double end = o_.until >= 0 ? std::min(o_.until, sim_.settings().time.end) : sim_.settings().time.end;
    first_time_ = sim_.time();
    while (!sim_.finished() && sim_.time() < end - 0.5 * dt) {
      sim_.step();
      particle_steps_ += static_cast<double>(sim_.world().particles().count());
      const double t = sim_.time();
      for (auto& m : sim_.take_messages()) say(m);
      record(t, dt);
      if (frames_ && frames_clock_.due(t, dt)) {
        frames_->write(sim_.world());
        frames_clock_.done(t, dt);
      }
      if (checkpoint_clock_.every > 0 && checkpoint_clock_.due(t, dt)) {
        save();
        checkpoint_clock_.done(t, dt);
      }
      if (o_.stop && o_.stop->load()) throw Error(Fault::interrupted, "interrupted at t = " + brief_quantity(t, "s"));
      // Reading the clock costs more than a small step.
      if (sim_.step_count() % 16 != 0) continue;
      const double now = seconds();
      if (o_.progress && now - last_progress_ > 0.2) {
        report_progress(now, end);
        last_progress_ = now;
      }
      if (out.checkpoint_every_wall > 0 && now - last_checkpoint_ > out.checkpoint_every_wall) {
        save();
        facts_.status = "running";
        write_summary();
      }
    }
  }

  void record(double t, double dt) {
    for (std::size_t k = 0; k < sim_.sensors().size(); ++k) {
      Sensor& s = *sim_.sensors()[k];
      const bool due = sample_[k].due(t, dt);
      if (!due && !s.row_due()) continue;
      facts_.last[k] = s.sample(sim_.world());
      series_[k]->write(t, facts_.last[k]);
      if (due) sample_[k].done(t, dt);
    }
  }

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

  /// checkpoint: false after numbers went wrong, so that the last good one stays.
  void finish(bool checkpoint) {
    const double t = sim_.time(), dt = sim_.time_step();
    for (std::size_t k = 0; k < sim_.sensors().size(); ++k) {
      if (!checkpoint || facts_.status == "interrupted") break;
      if (sample_[k].next > t + 0.5 * dt && sample_[k].next - sample_[k].every > t - 0.5 * dt) continue;
      facts_.last[k] = sim_.sensors()[k]->sample(sim_.world());
      series_[k]->write(t, facts_.last[k]);
    }
    if (checkpoint) save();
    if (frames_ && (facts_.status != "interrupted") && frames_clock_.next - frames_clock_.every < t - 0.5 * dt)
      frames_->write(sim_.world());
    write_summary();
  }

  void report_progress(double now, double end) {
    const double t = sim_.time(), share = (t - first_time_) / std::max(end - first_time_, 1e-300);
    const double left = share > 0 ? (now - start_) * (1 - share) / share : 0;
    char text[200];
    std::snprintf(text, sizeof text, "t = %.4f of %.4g s  %3.0f %%  %zu particles  %.2f M particle-steps/s  %s left", t,
                  end, 100 * share, sim_.world().particles().count(),
                  particle_steps_ / std::max(now - start_, 1e-9) * 1e-6, clock_text(left).c_str());
    o_.progress(text);
  }

  void say(const std::string& text) {
    log_info(text);
    facts_.notes.push_back(text);
    if (o_.message) o_.message(text);
  }

  std::string last_checkpoint_text() const {
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
  double start_ = 0, last_progress_ = 0, last_checkpoint_ = 0, checkpoint_time_ = -1, first_time_ = 0;
  double particle_steps_ = 0;
};

}  // namespace

std::string run_folder(const RunOptions& options) {
  if (!options.out.empty()) return options.out;
  fs::path p(options.case_path);
  if (p.extension() == ".json") p.replace_extension();
  return p.string() + ".out";
}

std::string run_case(const RunOptions& options) {
  return Run(options, read_case(options.case_path, options.overrides)).go();
}

std::string check_case(const RunOptions& options) {
  Simulation sim(read_case(options.case_path, options.overrides), options.simulation);
  const CaseSettings& c = sim.settings();
  std::string out;
  auto line = [&](const std::string& text) { out += text + "\n"; };
  line(c.title.empty() ? c.file : c.title);
  line("");
  line("Time step " + brief_quantity(sim.time_step(), "s") + (c.time.step > 0 ? " (given)" : "") + "; limits:");
  for (const auto& l : sim.step_limits())
    line("  " + std::string(l.binds ? "* " : "  ") + l.name +
         std::string(l.name.size() < 9 ? 9 - l.name.size() : 0, ' ') + brief_quantity(l.seconds, "s") + "  " + l.where +
         (l.binds ? "  <- binds" : ""));
  double mass = 0, particles = 0, spheres = 0;
  const auto& shapes = sim.world().particles().shapes;
  for (const auto& s : c.sources) {
    std::size_t members = 1;
    double volume = 0, density = 0;
    for (const auto& shape : shapes)
      if (shape.name == s.shape) members = shape.members.size(), volume = shape.volume;
    for (const auto& m : c.materials)
      if (m.name == s.material) density = m.density;
    const double each = density * volume * std::pow(s.size.kind == SizeSettings::Kind::fixed ? s.size.scale : 1.0, 3);
    const double n = s.count > 0  ? static_cast<double>(s.count)
                     : s.mass > 0 ? s.mass / each
                                  : static_cast<double>(s.positions.size());
    mass += n * each;
    particles += n;
    spheres += n * static_cast<double>(members);
    line("Source \"" + s.name + "\": " + brief_quantity(n * each, "kg") + ", about " + format_number(std::round(n)) +
         " particles of \"" + s.shape + "\"");
  }
  const double steps = c.time.end / sim.time_step(), work = steps * spheres;
  // Measured on two cores of a server of 2024 with Hertz-Mindlin and EpAM; an order of magnitude for other machines.
  constexpr double kSphereStepsPerCore = 5e6;
  const int threads = options.simulation.threads > 0 ? options.simulation.threads : omp_get_max_threads();
  line("Size: " + brief_quantity(mass, "kg") + ", " + format_number(std::round(particles)) + " particles, " +
       format_number(std::round(spheres)) + " spheres, " + format_number(std::round(steps)) + " steps, " +
       format_number(std::round(particles * steps / 1e6) * 1e6) + " particle-steps");
  line("Memory: about " + brief_quantity(std::round(spheres * 600 / 1e6), "1") + " MB");
  line("Cost: about " + clock_text(work / (kSphereStepsPerCore * threads)) + " on " + std::to_string(threads) +
       " threads at " + format_number(kSphereStepsPerCore * threads / 1e6) + " M sphere-steps/s (estimate)");
  line("Device: cpu, double precision, " + std::to_string(threads) + " threads; every plugin runs there");
  line("Materials:");
  for (const auto& m : c.materials) {
    line("  " + m.name + (m.density > 0 ? ", density " + brief_quantity(m.density, "kg/m^3") : ""));
  }
  line("Contacts:");
  for (const auto& contact : c.contacts)
    for (const auto& law : contact.laws) line("  " + contact.between[0] + "-" + contact.between[1] + ": " + law.law);
  if (!sim.presets().empty()) line("Left to presets:");
  for (const auto& p : sim.presets()) line("  " + p);
  line("Parts:");
  for (std::size_t k = 0; k < c.parts.size(); ++k) {
    const auto faults = sim.world().part_surface(k).faults().describe();
    line("  " + c.parts[k].name + ": " + c.parts[k].geometry + ", " +
         std::to_string(sim.world().part_surface(k).element_count()) + " surface elements" +
         (c.parts[k].motion.empty() ? "" : ", moved by \"" + c.parts[k].motion + "\"") +
         (faults.empty() ? "" : " (" + faults + ")"));
  }
  line("Plugins:");
  for (const auto& p : sim.provenance())
    line("  " + p.id + " " + p.version + "  sha256 " + p.sha256.substr(0, 12) + "  " + p.path);
  if (!c.assumptions.empty()) line("Assumptions:");
  for (const auto& a : c.assumptions) line("  - " + a);
  return out;
}

}  // namespace calx
