// Instruments: closed forms on a recorded series, the same figures in a run, state in checkpoints, bad input.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "effects/machine.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

EffectInfo effect_of(const std::string& id) {
  for (const EffectInfo& e : list_effects({CALX_PLUGIN_DIR}))
    if (e.id == id) return e;
  throw std::runtime_error("no effect " + id);
}

std::vector<double> shown(const std::string& id, const std::vector<std::pair<std::string, double>>& values,
                          const std::vector<double>& t, const std::vector<double>& x) {
  PluginRegistry registry({CALX_PLUGIN_DIR});
  return apply_instruments(registry, instruments_of(effect_of(id), values), t, x);
}

std::string fault(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a lag answers a ramp and a step as a first-order system") {
  std::vector<double> t, ramp, step;
  for (int k = 0; k <= 400; ++k) {
    t.push_back(0.01 * k);
    ramp.push_back(3 * t.back());
    step.push_back(k < 100 ? 0.0 : 1.0);
  }
  const double lag = 0.25;
  const auto after_ramp = shown("calx.load-cell-lag", {{"lag", lag}}, t, ramp);
  const auto after_step = shown("calx.load-cell-lag", {{"lag", lag}}, t, step);
  for (std::size_t k = 0; k < t.size(); ++k) {
    CHECK(after_ramp[k] == doctest::Approx(3 * (t[k] - lag * (1 - std::exp(-t[k] / lag)))).epsilon(1e-12));
    // The step is a ramp over one sample, from 0.99 s to 1 s; its mean delay is half a sample.
    const double after = t[k] - 0.995;
    if (after > 0.01) CHECK(after_step[k] == doctest::Approx(1 - std::exp(-after / lag)).epsilon(2e-4));
  }
}

TEST_CASE("drift, tare, gain and pick-up are what they say, and all off give the series itself") {
  const std::vector<double> t = {0, 1, 2.5, 4}, x = {0.1, 0.2, 0.4, 0.3};
  const auto drift = shown("calx.load-cell-drift", {{"gain_rate", 0.01}, {"zero_rate", 0.002}}, t, x);
  const auto tare = shown("calx.load-cell-tare", {{"offset", -0.05}}, t, x);
  const auto gain = shown("calx.load-cell-gain", {{"error", 0.1}}, t, x);
  const auto pickup =
      shown("calx.vibration-pickup", {{"amplitude", 0.01}, {"frequency", 0.3}, {"phase_deg", 90}}, t, x);
  for (std::size_t k = 0; k < t.size(); ++k) {
    CHECK(drift[k] == doctest::Approx(x[k] * (1 + 0.01 * t[k]) + 0.002 * t[k]).epsilon(1e-14));
    CHECK(tare[k] == doctest::Approx(x[k] - 0.05).epsilon(1e-14));
    CHECK(gain[k] == doctest::Approx(1.1 * x[k]).epsilon(1e-14));
    CHECK(pickup[k] == doctest::Approx(x[k] + 0.01 * std::cos(2 * 3.141592653589793 * 0.3 * t[k])).epsilon(1e-12));
  }
  int instruments = 0;
  for (const EffectInfo& e : list_effects({CALX_PLUGIN_DIR})) {
    if (!e.is_instrument) continue;
    ++instruments;
    CHECK(shown(e.id, {}, t, x) == x);
  }
  CHECK(instruments == 5);
}

TEST_CASE("a run shows what the series of a run without the instrument would have been turned into") {
  const std::string lag = R"([{"effect": "calx.load-cell-lag", "parameters": {"lag": 0.01}},
                              {"effect": "calx.load-cell-gain", "parameters": {"error": 0.02}}])";
  Simulation with = machine(lag), without = machine("");
  std::vector<double> t, x, y;
  for (int k = 0; k < 40; ++k) {
    for (int n = 0; n < 50; ++n) with.step(), without.step();
    t.push_back(without.time());
    x.push_back(without.sensors()[0]->sample(without.world())[0]);
    y.push_back(with.sensors()[0]->sample(with.world())[0]);
  }
  PluginRegistry registry({CALX_PLUGIN_DIR});
  auto uses = instruments_of(effect_of("calx.load-cell-lag"), {{"lag", 0.01}});
  uses.push_back(instruments_of(effect_of("calx.load-cell-gain"), {{"error", 0.02}}).at(0));
  CHECK(apply_instruments(registry, uses, t, x) == y);
  CHECK(x != y);
}

TEST_CASE("what an instrument remembers is in the checkpoint") {
  const std::string lag = R"([{"effect": "calx.load-cell-lag", "parameters": {"lag": 0.02}}])";
  const auto advance = [](Simulation& sim, int rows) {
    std::vector<double> out;
    for (int k = 0; k < rows; ++k) {
      for (int n = 0; n < 50; ++n) sim.step();
      out.push_back(sim.sensors()[0]->sample(sim.world())[0]);
    }
    return out;
  };
  Simulation whole = machine(lag), first = machine(lag), second = machine(lag);
  advance(whole, 20);
  advance(first, 20);
  MemoryState state;
  first.save(state);
  second.load(state);
  CHECK(advance(second, 10) == advance(whole, 10));
}

TEST_CASE("what is wrong with the use of an instrument is said") {
  const std::vector<double> t = {0, 1, 1}, x = {1, 2, 3};
  CHECK(fault([&] {
          shown("calx.load-cell-lag", {{"lag", 0.1}}, t, x);
        }) == "time 1 s of row 3 of the series does not rise; must be above the one before");
  CHECK(fault([&] {
          shown("calx.load-cell-lag", {{"lagg", 0.1}}, {0, 1}, {1, 2});
        }) == "effect calx.load-cell-lag has no parameter \"lagg\"; did you mean \"lag\"?");
  CHECK(fault([&] {
          shown("calx.rotor-leak", {}, {0, 1}, {1, 2});
        }) == "effect calx.rotor-leak is no instrument; it changes what happens, so it needs a run");
  CHECK(fault([&] { machine(R"([{"effect": "calx.load-cell-lag", "parameters": {"lag": -1}}])"); }) ==
        "machine.json /effects/0/parameters/lag: -1 s is out of range; effect calx.load-cell-lag allows 0 to 10000 s");
  const auto sensor = [](const std::string& keys) {
    std::string text = machine_text("");
    const std::string cell = "\"region\": \"low\", ";
    text.replace(text.find(cell), cell.size(), cell + keys + ", ");
    SimulationOptions options;
    options.plugin_path = {CALX_PLUGIN_DIR};
    return fault([&] { Simulation(parse_case(text, "machine.json"), options); });
  };
  CHECK(sensor(R"("instruments": [{"plugin": "calx.load-cell-lag", "column": "mas_kg"}])") ==
        "machine.json /sensors/0/instruments/0/column: sensor \"cell\" has no column \"mas_kg\"; did you mean "
        "\"mass_kg\"?");
  CHECK(
      sensor(R"("instruments": [{"plugin": "calx.centroid"}])") ==
      "machine.json /sensors/0/instruments/0: calx.centroid gives 4 numbers, so it is no instrument, which gives one");
}
