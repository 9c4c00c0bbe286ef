// machine.hpp: a small machine in which every effect of the tree finds its role: a few grains on the rotor of a rotary
// valve, in a pocket and in a canister.
#pragma once
#include <string>
#include <vector>

#include "config/config.hpp"
#include "plugin/effects.hpp"
#include "sim/simulation.hpp"

namespace calx {

inline std::string machine_text(const std::string& effects) {
  return R"({"calx": 1, "gravity": [0, 0, -9.81],
  "domain": {"min": [-0.12, -0.12, -0.05], "max": [0.16, 0.12, 0.7], "on_leave": "delete"},
  "time": {"step": 2e-5, "end": 10}, "overlap_limit": 0.95, "seed": 3,
  "materials": {"powder": {"density": 2017, "young": 2.5e6, "poisson": 0.25},
                "steel": {"density": 7850, "young": 2.5e7, "poisson": 0.25}},
  "contacts": [
    {"between": ["powder", "powder"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.4, "friction": 0.5}},
    {"between": ["powder", "steel"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.4, "friction": 0.35}}],
  "shapes": {"grain": {"sphere": {"radius": 0.002}}},
  "regions": {"region": {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 0.3], "radius": 0.04}},
              "low": {"box": {"min": [-0.03, -0.03, 0], "max": [0.03, 0.03, 0.008]}}},
  "sources": [
    {"name": "fill", "shape": "grain", "material": "powder", "count": 40,
     "region": {"box": {"min": [0.048, -0.015, 0.548], "max": [0.067, 0.015, 0.575]}}},
    {"name": "bed", "shape": "grain", "material": "powder", "count": 40,
     "region": {"box": {"min": [-0.02, -0.02, 0.003], "max": [0.02, 0.02, 0.02]}}}],
  "parts": [
    {"name": "housing", "geometry": "calx.rotary-housing", "material": "steel"},
    {"name": "rotor", "geometry": "calx.rotary-valve", "material": "steel", "motion": "rotor turn"},
    {"name": "butterfly", "geometry": "calx.butterfly-valve", "material": "steel", "motion": "motion",
     "parameters": {"position": [0.0577, 0, 0.59]}},
    {"name": "nozzle", "geometry": "calx.nozzle-port", "material": "steel", "parameters": {"piece": "nozzle"}},
    {"name": "canister", "geometry": "calx.cylinder", "material": "steel", "motion": "shake",
     "parameters": {"from": [0, 0, 0], "to": [0, 0, 0.05], "radius": 0.03, "caps": "bottom"}}],
  "motions": {
    "rotor turn": {"plugin": "calx.reciprocate",
                   "parameters": {"origin": [0.0577, 0, 0.535], "axis": [0, 1, 0], "swing_deg": 180, "stroke": 0.1}},
    "motion": {"plugin": "calx.open-close",
               "parameters": {"origin": [0.0577, 0, 0.59], "axis": [0, 1, 0], "angle_to_deg": 90, "duration": 0.04}},
    "shake": {"plugin": "calx.vibration", "parameters": {"amplitude": 0.0002, "frequency": 50}}},
  "sensors": [{"name": "cell", "kind": "mass", "region": "low", "every": 0.002},
              {"name": "centre", "kind": "calx.centroid", "every": 0.01}])" +
         (effects.empty() ? "" : ", \"effects\": " + effects) + "}";
}

/// One effect at off, or with its first amplitude at `strength` scales; no roles given.
inline std::string use_of(const EffectInfo& effect, double strength = 0) {
  std::string values;
  bool first = true;
  for (const EffectParameter& p : effect.parameters) {
    if (!p.is_amplitude) continue;
    const double side = p.sign == EffectParameter::Sign::negative ? -1 : 1;
    values += (values.empty() ? "" : ", ") + ("\"" + p.name + "\": ") +
              std::to_string(p.off + (first ? strength * side * p.scale : 0));
    first = false;
  }
  return R"([{"effect": ")" + effect.id + R"(", "parameters": {)" + values + "}}]";
}

inline Simulation machine(const std::string& effects) {
  const PluginEffects library({CALX_PLUGIN_DIR});
  SimulationOptions options;
  options.threads = 1;
  options.plugin_path = {CALX_PLUGIN_DIR};
  return Simulation(parse_case(machine_text(effects), "machine.json", {}, &library), options);
}

/// Everything that a run without the effect could show: particles bit for bit, and rows of all sensors.
inline std::vector<double> history(Simulation& sim, int steps, int every) {
  std::vector<double> out;
  for (int k = 1; k <= steps; ++k) {
    sim.step();
    if (k % every != 0) continue;
    for (const auto& s : sim.sensors())
      for (const double v : s->sample(sim.world())) out.push_back(v);
  }
  const Particles& p = sim.world().particles();
  for (std::size_t k = 0; k < p.count(); ++k) {
    const Record& b = p.body[k];
    out.insert(out.end(), {static_cast<double>(p.id[k]), b.x, b.y, b.z, b.vx, b.vy, b.vz, b.wx, b.wy, b.wz, b.m});
  }
  return out;
}

}  // namespace calx
