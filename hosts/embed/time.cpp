// time.cpp: steps, callbacks and messages.
#include <cmath>

#include "simulation.hpp"

using namespace calx;

namespace {

/// Steps while go_on holds; callbacks and messages as asked for. Returns false when a callback stopped it.
template <class GoOn>
bool advance(calx_sim& sim, const GoOn& go_on) {
  if (sim.stepping) misused("a callback cannot step the simulation it is called from");
  struct Stepping {  // also when a step throws
    bool& flag;
    explicit Stepping(bool& f) : flag(f) { flag = true; }
    ~Stepping() { flag = false; }
  } stepping(sim.stepping);
  Simulation& s = *sim.simulation;
  while (!s.finished() && go_on()) {
    s.step();
    for (const std::string& message : s.take_messages())
      if (sim.on_message) sim.on_message(message.c_str(), sim.message_user);
    if (sim.on_step && s.step_count() % sim.every == 0 && sim.on_step(&sim, sim.step_user) != 0) return false;
  }
  return true;
}

template <class GoOn>
std::int32_t run(calx_sim* sim, const char* function, const GoOn& go_on) {
  bool stopped = false;
  const std::int32_t code = guarded([&] { stopped = !advance(needed(sim, function, "sim"), go_on); });
  return code == CALX_SIM_OK && stopped ? failed(CALX_SIM_STOPPED, "a callback asked to stop") : code;
}

}  // namespace

std::int32_t calx_sim_step(calx_sim* sim, std::uint64_t steps) {
  return run(sim, "calx_sim_step", [&] { return steps-- > 0; });
}

std::int32_t calx_sim_run_until(calx_sim* sim, double time) {
  if (!std::isfinite(time)) return failed(CALX_SIM_USAGE, "calx_sim_run_until: the time is not finite");
  return run(sim, "calx_sim_run_until",
             [&] { return sim->simulation->time() < time - 0.5 * sim->simulation->time_step(); });
}

std::int32_t calx_sim_run_until_event(calx_sim* sim, const char* event, double latest, std::int32_t* fired) {
  const char* const function = "calx_sim_run_until_event";
  const std::int32_t code = guarded([&] {
    const auto& events = needed(sim, function, "sim").simulation->settings().events;
    const std::string name = &needed(event, function, "event");
    needed(fired, function, "fired");
    for (const auto& e : events)
      if (e.name == name) return;
    misused(std::string(function) + ": the case has no event \"" + name + "\"");
  });
  if (code != CALX_SIM_OK) return code;
  const auto happened = [&] { return sim->simulation->world().event_time(event) >= 0; };
  const std::int32_t end = run(sim, function, [&] {
    return !happened() && sim->simulation->time() < latest - 0.5 * sim->simulation->time_step();
  });
  if (end == CALX_SIM_OK) *fired = happened();
  return end;
}

double calx_sim_time(const calx_sim* sim) { return sim ? sim->simulation->time() : 0; }
double calx_sim_time_step(const calx_sim* sim) { return sim ? sim->simulation->time_step() : 0; }
std::uint64_t calx_sim_steps(const calx_sim* sim) { return sim ? sim->simulation->step_count() : 0; }
std::int32_t calx_sim_finished(const calx_sim* sim) { return sim && sim->simulation->finished(); }

std::int32_t calx_sim_on_step(calx_sim* sim, std::uint64_t every, calx_sim_callback call, void* user) {
  return guarded([&] {
    calx_sim& s = needed(sim, "calx_sim_on_step", "sim");
    if (call && every == 0) misused("calx_sim_on_step: every is 0; 1 means after each step");
    s.on_step = call;
    s.every = every;
    s.step_user = user;
  });
}

std::int32_t calx_sim_on_message(calx_sim* sim, calx_sim_listener call, void* user) {
  return guarded([&] {
    calx_sim& s = needed(sim, "calx_sim_on_message", "sim");
    s.on_message = call;
    s.message_user = user;
  });
}
