// cases.hpp: cases shared by the tests of this folder.
#pragma once

// Every key a case can have stands here at least once.
inline const char* full_case() {
  return R"({
  // a comment, as users write them
  "calx": 1, "title": "Canister fill", "$schema": "case.schema.json",
  "gravity": [0, 0, -9.81],
  "domain": {"min": [-0.1, -0.1, 0], "max": [0.1, 0.1, {"value": 40, "unit": "cm"}],
             "periodic": [true, false, false], "on_leave": "delete"},
  "time": {"integrator": "verlet", "rayleigh_fraction": 0.2, "step": 1e-6, "end": 12.0, "end_event": "full"},
  "seed": 7,
  "materials": {
    "steel": {"young": 1.82e11, "poisson": 0.3},
    "calcine": {"density": {"value": 2.017, "unit": "g/cm^3"}, "young": {"value": 25, "unit": "MPa"}, "poisson": 0.25}
  },
  "contacts": [
    {"between": ["calcine", "calcine"], "law": "calx.epam", "parameters": {"k1": 2e5}},
    {"between": ["calcine", "steel"], "laws": [
      {"law": "calx.epam", "parameters": {"k1": 3e5}},
      {"law": "calx.epam", "name": "extra cohesion"}]}
  ],
  "shapes": {
    "grain": {"spheres": [{"at": [0, 0, -0.0003], "radius": 0.00125}, {"at": [0, 0, 0.0003], "radius": {"value": 1.25, "unit": "mm"}}]},
    "ball": {"sphere": {"radius": 0.002}}
  },
  "regions": {
    "hopper": {"cone": {"from": [0, 0, 0.2], "to": [0, 0, 0.3], "radius_from": 0.02, "radius_to": 0.05}},
    "canister": {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 0.1], "radius": 0.03}, "follows": "canister"},
    "all": {"box": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    "drop": {"sphere": {"centre": {"value": [0, 0, 100], "unit": "mm"}, "radius": 0.01}}
  },
  "sources": [
    {"name": "hopper fill", "shape": "grain", "material": "calcine", "size": {"distribution": "normal", "mean": 1.1, "deviation": 0.1},
     "region": "hopper", "mass": 0.6, "rate": 0.1, "velocity": [0, 0, -1], "when": {"time": 0.5}, "random_orientation": false},
    {"name": "few", "shape": "ball", "material": "calcine", "size": 1.5, "region": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "count": 10,
     "when": "full"},
    {"name": "placed", "shape": "ball", "material": "calcine", "size": {"scale": 2}, "positions": [[0, 0, 0.1], [0, 0, 0.2]],
     "orientations": [[1, 0, 0, 0], [0.6, 0.8, 0, 0]], "velocities": [[0, 0, 1], [0, 0, 2]], "spins": [[1, 0, 0], [2, 0, 0]]},
    {"name": "sizes", "shape": "ball", "material": "calcine", "count": 5, "region": "drop",
     "size": {"distribution": "list", "scales": [1, 2], "shares": [3, 1]}},
    {"name": "even", "shape": "ball", "material": "calcine", "count": 5, "region": "drop",
     "size": {"distribution": "uniform", "lowest": 0.9, "highest": 1.3}},
    {"name": "skewed", "shape": "ball", "material": "calcine", "count": 5, "region": "drop",
     "size": {"distribution": "lognormal", "median": 1, "deviation": 0.2, "lowest": 0.5, "highest": 2}}
  ],
  "parts": [
    {"name": "canister", "geometry": "calx.cylinder", "parameters": {"radius": 0.03}, "material": "steel", "motion": "lift"},
    {"name": "rotor", "geometry": "calx.rotary-valve", "material": "steel", "motion": "rotor turn", "appears": "valve open",
     "vanishes": {"time": 9}, "present": false, "assumed": true}
  ],
  "motions": {
    "lift": {"plugin": "calx.linear"},
    "rotor turn": {"plugin": "calx.reciprocate", "parameters": {"swing_deg": 180}, "start": "valve open", "carried_by": "lift"}
  },
  "events": {
    "valve open": {"when": {"settled": {"region": "hopper", "kinetic_per_particle": 1e-9, "hold": 0.1, "not_before": 0.2}}},
    "full": {"when": {"any": [
      {"mass": {"region": "canister", "at_least": {"value": 500, "unit": "g"}}},
      {"all": [{"count": {"region": {"sphere": {"centre": [0, 0, 0], "radius": 1}}, "at_most": 3}}, {"event": "valve open"}]},
      {"cycle": {"motion": "rotor turn", "number": 40}},
      {"after": {"event": "valve open", "delay": {"value": 1, "unit": "min"}}}]}}
  },
  "stages": [{"name": "fill", "until": "full", "add": ["canister"], "remove": ["rotor"], "start": ["lift"]}, {"name": "rest", "until": {"all": [{"mass": {"at_most": 1}}, {"count": {"at_least": 5}}]}}],
  "forces": [{"plugin": "calx.drag", "parameters": {"viscosity": 1.8e-5}}],
  "sensors": [
    {"name": "canister mass", "kind": "mass", "region": "canister", "every": 0.01,
     "instruments": [{"plugin": "calx.load-cell-lag", "column": "mass_kg", "parameters": {"time": 0.1}}]},
    {"name": "inline", "kind": "bulk-density", "region": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "every": 0.01},
    {"name": "own", "plugin": "org.example.sensor", "every": {"value": 10, "unit": "ms"}, "depth": 3}
  ],
  "output": {"frames_every": 0.05, "checkpoint_every_wall": 30, "checkpoint_every": 1, "particles_h5": false},
  "neighbour": {"skin": {"value": 0.2, "unit": "mm"}},
  "rest": {"after": {"value": 5, "unit": "ms"}, "displacement": 1e-4, "force": 0.02},
  "scale": {"factor": 1, "cohesion": "bond"},
  "energy": true, "overlap_limit": 0.3,
  "effects": [{"effect": "org.example.tilt", "version": "1.0.0", "on": {"canister": "canister"}, "parameters": {"tilt_deg": 1},
               "expanded": true}],
  "assumptions": ["rotor diameter is not in the paper: 50 mm"],
  "plugins": {"org.example.sensor": {"sha256": "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}}
})";
}

// The least a case can be.
inline const char* least_case() {
  return R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1}})";
}
