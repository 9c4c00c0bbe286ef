// scenes.hpp: the scenes that determinism and restart share.
#pragma once
#include "support/case.hpp"

namespace calx {

inline const char* const kEpamContacts = R"([
  {"between": ["sand", "sand"], "law": "calx.epam",
   "parameters": {"restitution": 0.4, "friction": 0.5, "plasticity": 0.4, "surface_energy": 0.1, "rolling": "epsd",
                  "rolling_friction": 0.05}},
  {"between": ["sand", "steel"], "law": "calx.epam",
   "parameters": {"restitution": 0.4, "friction": 0.35, "plasticity": 0.4, "surface_energy": 0.05, "rolling": "epsd",
                  "rolling_friction": 0.05}}])";
inline const char* const kTwoMaterials =
    R"({"sand": {"density": 2000, "young": 2.5e6, "poisson": 0.25}, "steel": {"density": 7800, "young": 2.5e7, "poisson": 0.25}})";

/// 2400 cohesive clumps flying into each other and on a shaken floor, periodic in x and y.
inline CaseFile shaken_clumps(const std::string& integrator) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [0, 0, -0.02], "max": [0.027, 0.0324, 0.2], "periodic": [true, true, false]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.materials = kTwoMaterials;
  c.contacts = kEpamContacts;
  c.parts = R"([{"name": "floor", "geometry": "calx.box", "material": "steel", "motion": "shake",
                 "parameters": {"min": [-0.05, -0.05, -0.01], "max": [0.08, 0.08, 0]}}])";
  c.more = R"("motions": {"shake": {"plugin": "calx.vibration", "parameters": {"direction": [0.3, 0, 1],
               "amplitude": 2e-4, "frequency": 200}}})";
  return with_given(c, "grain", lattice(2400, 10, 12, 2.7e-3, {0, 0, 2e-4}, 5e-5, 0.6));
}

/// 3000 frictional spheres flying about in a box.
inline CaseFile sphere_bed(const std::string& integrator, std::uint64_t seed = 1) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.01, -0.01, -0.01], "max": [0.1, 0.1, 0.3]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "sand",
                 "parameters": {"min": [0, 0, 0], "max": [0.033, 0.033, 0.2]}}])";
  return with_given(c, "ball", lattice(3000, 15, 15, 2.15e-3, {4e-4, 4e-4, 4e-4}, 5e-5, 0.6, seed));
}

/// Everything at once: sources by rate and at an event, sizes drawn, a moving and a vanishing part, drag, particles
/// lost over the rim, the energy ledger.
inline CaseFile pouring(const std::string& integrator) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.03, -0.03, -0.003], "max": [0.03, 0.03, 0.1], "on_leave": "count"})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.materials = kTwoMaterials;
  c.contacts = kEpamContacts;
  c.sources = R"([
    {"name": "rain", "shape": "grain", "material": "sand", "mass": 0.004, "rate": 0.6, "velocity": [0.4, 0, -2],
     "size": {"distribution": "list", "scales": [0.8, 1, 1.1], "shares": [0.3, 0.4, 0.3]},
     "region": {"box": {"min": [-0.012, -0.012, 0.008], "max": [0.012, 0.012, 0.022]}}},
    {"name": "second", "shape": "odd", "material": "sand", "count": 30, "when": {"time": 0.004}, "velocity": [0, 0, -1],
     "region": {"box": {"min": [-0.01, -0.01, 0.03], "max": [0.01, 0.01, 0.04]}}}])";
  c.parts = R"([{"name": "table", "geometry": "calx.plane", "material": "steel", "motion": "shake",
                 "parameters": {"point": [0, 0, 0], "half_u": 0.009, "half_v": 0.009}},
                {"name": "fence", "geometry": "calx.plane", "material": "steel", "vanishes": {"time": 0.006},
                 "parameters": {"point": [0.012, 0, 0.01], "normal": [1, 0, 0], "half_u": 0.02, "half_v": 0.01}}])";
  c.more = R"("motions": {"shake": {"plugin": "calx.vibration", "start": {"time": 0.003},
      "parameters": {"direction": [1, 0, 1], "amplitude": 3e-4, "frequency": 150}}},
    "forces": [{"plugin": "calx.stokes-drag", "parameters": {"viscosity": 1e-3, "correction": "schiller-naumann"}}],
    "sensors": [{"name": "out", "kind": "mass", "every": 0.001}], "energy": true, "seed": 11)";
  return c.file();
}

}  // namespace calx
