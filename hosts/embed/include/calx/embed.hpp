// SPDX-License-Identifier: MIT
// calx/embed.hpp: calx/embed.h as C++11 classes: errors as exceptions, ownership by scope. Header only; see embed.h for
// units, frames, threads and what stays valid how long.
#ifndef CALX_EMBED_HPP
#define CALX_EMBED_HPP
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "embed.h"

namespace calx {
namespace embed {

/// A code of embed.h other than CALX_SIM_OK, with its message.
class Failure : public std::runtime_error {
 public:
  Failure(std::int32_t code, const std::string& message) : std::runtime_error(message), code_(code) {}
  std::int32_t code() const { return code_; }

 private:
  std::int32_t code_;
};

inline void check(std::int32_t code) {
  if (code != CALX_SIM_OK) throw Failure(code, calx_sim_error());
}

struct Options {
  int threads = 0;  // 0: all cores
  std::string device = "cpu", precision = "double", plugin_path, folder;
  std::vector<const calx_entry*> plugins;  // of this program; outlive every simulation
  std::vector<std::string> set;            // "/json/pointer=value"
};

/// Components of the engine's own memory, row by row; see calx_sim_column.
template <class T>
class Columns {
 public:
  explicit Columns(const calx_sim_column& c) : c_(c) {}
  std::size_t size() const { return static_cast<std::size_t>(c_.rows); }
  /// The first component of row k.
  T* operator[](std::size_t k) const { return reinterpret_cast<T*>(static_cast<char*>(c_.data) + k * c_.stride); }

 private:
  calx_sim_column c_;
};

class Simulation {
 public:
  /// Returns non-zero to stop; the stepping call then throws Failure with CALX_SIM_STOPPED. What it throws, that call
  /// throws.
  using OnStep = std::function<int(Simulation&)>;
  using OnMessage = std::function<void(const char*)>;

  static Simulation from_text(const std::string& case_json, const Options& options = Options()) {
    return Simulation(calx_sim_create, case_json, options);
  }
  static Simulation from_file(const std::string& case_path, const Options& options = Options()) {
    return Simulation(calx_sim_open, case_path, options);
  }

  calx_sim* get() const { return sim_.get(); }
  double time() const { return calx_sim_time(get()); }
  double time_step() const { return calx_sim_time_step(get()); }
  std::uint64_t steps() const { return calx_sim_steps(get()); }
  bool finished() const { return calx_sim_finished(get()) != 0; }
  void step(std::uint64_t count = 1) { stepped(calx_sim_step(get(), count)); }
  void run_until(double time) { stepped(calx_sim_run_until(get(), time)); }
  /// True when the event has fired.
  bool run_until_event(const std::string& event, double latest) {
    std::int32_t fired = 0;
    stepped(calx_sim_run_until_event(get(), event.c_str(), latest, &fired));
    return fired != 0;
  }

  void on_step(std::uint64_t every, OnStep call) {
    state_->on_step = std::move(call);
    check(calx_sim_on_step(get(), every, state_->on_step ? &step_hook : nullptr, this_state()));
  }
  void on_message(OnMessage call) {
    state_->on_message = std::move(call);
    check(calx_sim_on_message(get(), state_->on_message ? &message_hook : nullptr, this_state()));
  }

  std::size_t particle_count() const { return static_cast<std::size_t>(calx_sim_particle_count(get())); }
  /// Position, velocity, spin, orientation, mass or scale. Say particles_written() after writing.
  Columns<double> numbers(const char* name) { return Columns<double>(column(name, false)); }
  /// Id, material or shape.
  Columns<const std::uint32_t> integers(const char* name) { return Columns<const std::uint32_t>(column(name, true)); }
  void particles_written() { check(calx_sim_particles_written(get())); }

  std::uint32_t part(const std::string& name) const {
    std::uint32_t number = 0;
    check(calx_sim_part(get(), name.c_str(), &number));
    return number;
  }
  calx_sim_pose pose(std::uint32_t part) const {
    calx_sim_pose out;
    check(calx_sim_part_pose(get(), part, &out));
    return out;
  }
  struct Load {
    double force[3], torque[3];  // N, N m about the part's centre
  };
  Load load(std::uint32_t part) const {
    Load out;
    check(calx_sim_part_load(get(), part, out.force, out.torque));
    return out;
  }
  void drive(std::uint32_t part, const calx_sim_pose& pose) { check(calx_sim_drive_part(get(), part, &pose)); }

  std::uint32_t sensor(const std::string& name) const {
    std::uint32_t number = 0;
    check(calx_sim_sensor(get(), name.c_str(), &number));
    return number;
  }
  std::vector<double> sample(std::uint32_t sensor) {
    std::vector<double> values(calx_sim_sensor_columns(get(), sensor));
    double none = 0;
    check(calx_sim_sample(get(), sensor, values.empty() ? &none : values.data(),
                          static_cast<std::uint32_t>(values.size())));
    return values;
  }

  void save(const std::string& folder) const { check(calx_sim_save(get(), folder.c_str())); }
  void load_state(const std::string& folder) { check(calx_sim_load(get(), folder.c_str())); }
  std::string digest() const {
    char text[65];
    check(calx_sim_digest(get(), text));
    return text;
  }

 private:
  struct State {  // stays in place when a Simulation is moved
    Simulation* owner = nullptr;
    OnStep on_step;
    OnMessage on_message;
    std::exception_ptr thrown;
  };
  struct Destroy {
    void operator()(calx_sim* sim) const { calx_sim_destroy(sim); }
  };
  using Make = std::int32_t(CALX_CALL*)(const char*, const calx_sim_options*, calx_sim**);

  Simulation(Make make, const std::string& text, const Options& options) : state_(new State) {
    calx_sim_options o = calx_sim_options();
    o.struct_size = sizeof o;
    o.threads = options.threads;
    o.device = options.device.c_str();
    o.precision = options.precision.c_str();
    o.plugin_path = options.plugin_path.c_str();
    if (!options.folder.empty()) o.folder = options.folder.c_str();
    std::vector<const calx_entry*> plugins = options.plugins;
    plugins.push_back(nullptr);
    o.plugins = plugins.data();
    std::vector<const char*> set;
    for (const std::string& one : options.set) set.push_back(one.c_str());
    set.push_back(nullptr);
    o.set = set.data();
    calx_sim* made = nullptr;
    check(make(text.c_str(), &o, &made));
    sim_.reset(made);
  }

  State* this_state() {
    state_->owner = this;
    return state_.get();
  }
  static std::int32_t CALX_CALL step_hook(calx_sim*, void* user) {
    State& state = *static_cast<State*>(user);
    try {
      return state.on_step(*state.owner);
    } catch (...) {  // carried round the C functions in between
      state.thrown = std::current_exception();
      return 1;
    }
  }
  static void CALX_CALL message_hook(const char* message, void* user) {
    State& state = *static_cast<State*>(user);
    try {
      state.on_message(message);
    } catch (...) {
      state.thrown = std::current_exception();
    }
  }
  void stepped(std::int32_t code) {
    std::exception_ptr thrown;
    std::swap(thrown, state_->thrown);
    if (thrown) std::rethrow_exception(thrown);
    check(code);
  }
  calx_sim_column column(const char* name, bool integer) {
    calx_sim_column out;
    check(calx_sim_particles(get(), name, &out));
    if ((out.is_integer != 0) != integer)
      throw Failure(CALX_SIM_USAGE, std::string("column ") + name + (integer ? " holds numbers" : " holds integers"));
    return out;
  }

  std::unique_ptr<State> state_;
  std::unique_ptr<calx_sim, Destroy> sim_;
};

}  // namespace embed
}  // namespace calx
#endif
