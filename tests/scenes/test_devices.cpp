// The same bits on every device as on the processor: motion, history, energies, loads.
#include <doctest/doctest.h>

#include <fstream>
#include <memory>

#include "scenes/device_kinds.hpp"
#include "scenes/scenes.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

SimulationOptions on(const std::string& device) {
  SimulationOptions o = test_options(2);
  o.device = device;
  return o;
}

struct Outcome {
  std::string digest;
  Simulation::Counters counters;
  EnergyLedger energy;
  std::vector<Vec3> loads;
};

Outcome outcome(Simulation& sim) {
  Outcome out{sim.digest(), sim.counters(), sim.world().energy(), {}};
  for (std::size_t k = 0; k < sim.world().part_count(); ++k) {
    out.loads.push_back(sim.world().part_load(k).force);
    out.loads.push_back(sim.world().part_load(k).torque);
  }
  return out;
}

void check_same(const Outcome& a, const Outcome& b) {
  CHECK(a.digest == b.digest);
  CHECK(a.counters.touching == b.counters.touching);
  CHECK(a.counters.rebuilds == b.counters.rebuilds);
  CHECK(a.counters.pair_entries == b.counters.pair_entries);
  CHECK(a.counters.wall_entries == b.counters.wall_entries);
  CHECK(a.counters.largest_overlap == b.counters.largest_overlap);
  CHECK(a.energy.kinetic_translation == b.energy.kinetic_translation);
  CHECK(a.energy.kinetic_rotation == b.energy.kinetic_rotation);
  CHECK(a.energy.gravity == b.energy.gravity);
  CHECK(a.energy.elastic == b.energy.elastic);
  CHECK(a.energy.friction == b.energy.friction);
  CHECK(a.energy.damping == b.energy.damping);
  CHECK(a.energy.plastic == b.energy.plastic);
  CHECK(a.energy.wall_work == b.energy.wall_work);
  CHECK(a.energy.remainder == b.energy.remainder);
  for (std::size_t k = 0; k < a.loads.size(); ++k) CHECK(norm(a.loads[k] - b.loads[k]) == 0);
}

/// least: contacts there must be at the end for the scene to mean something.
void check_scene(const CaseFile& file, int steps, std::uint64_t least = 400, bool mixed = false) {
  const auto on = [mixed](const std::string& device) {
    SimulationOptions o = ::on(device);
    o.mixed = mixed;
    return o;
  };
  Simulation reference(file, on("cpu"));
  advance(reference, steps);
  const Outcome expected = outcome(reference);
  CHECK(expected.counters.touching > least);
  CHECK(expected.counters.rebuilds >= 4);
  for (const std::string& device : test_devices()) {
    CAPTURE(device);
    Simulation sim(file, on(device));
    CHECK(sim.device().find(device) == 0);
    advance(sim, steps);
    check_same(outcome(sim), expected);
  }
}

}  // namespace

TEST_CASE("cohesive clumps on a shaken floor in a periodic box: the bits of the processor on every device") {
  check_scene(shaken_clumps("euler"), 350);
  check_scene(shaken_clumps("verlet"), 200);
}

TEST_CASE("frictional spheres in a box: the bits of the processor on every device") {
  check_scene(sphere_bed("euler"), 350);
  check_scene(sphere_bed("verlet"), 200);
}

namespace {

/// Powder of clumps with EpAM on itself and Hertz-Mindlin on steel, poured on a turning rotary valve over an inclined
/// mesh: triangles, surfaces of revolution, two laws of different history, a part that moves.
CaseFile valve() {
  const std::string stl = CALX_TEST_CACHE "/plate.stl";
  std::ofstream(stl) << "solid plate\n"
                        "facet normal 0 0 1\nouter loop\nvertex 30 -40 570\nvertex 60 -40 563\nvertex 60 40 563\n"
                        "endloop\nendfacet\n"
                        "facet normal 0 0 1\nouter loop\nvertex 30 -40 570\nvertex 60 40 563\nvertex 30 40 570\n"
                        "endloop\nendfacet\nendsolid plate\n";
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.1, -0.1, 0.4], "max": [0.2, 0.1, 0.8]})";
  c.time = R"({"step": 2e-5, "end": 10})";
  c.materials = kTwoMaterials;
  c.contacts = R"([
    {"between": ["sand", "sand"], "law": "calx.epam",
     "parameters": {"restitution": 0.4, "friction": 0.5, "plasticity": 0.4, "surface_energy": 0.1, "rolling": "epsd",
                    "rolling_friction": 0.05}},
    {"between": ["sand", "steel"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0.35}}])";
  c.parts = R"([
    {"name": "housing", "geometry": "calx.rotary-housing", "material": "steel"},
    {"name": "rotor", "geometry": "calx.rotary-valve", "material": "steel", "motion": "turn"},
    {"name": "plate", "geometry": "calx.mesh", "material": "steel",
     "parameters": {"file": ")" +
            stl + R"(", "unit": "mm", "allow_open": "yes"}}])";
  c.more = R"("motions": {"turn": {"plugin": "calx.reciprocate", "parameters": {"origin": [0.0577, 0, 0.535],
               "axis": [0, 1, 0], "swing_deg": 180, "stroke": 0.1, "dwell": 0.01, "cycles": 3}}}, "energy": true)";
  std::vector<Given> grains = lattice(700, 12, 12, 2.8e-3, {0.0415, -0.016, 0.5745}, 5e-5, 0.3);
  for (Given& g : grains) g.v.z -= 1;
  return with_given(c, "grain", grains);
}

}  // namespace

TEST_CASE("EpAM and Hertz-Mindlin on a mesh and a turning rotary valve: the bits of the processor on every device") {
  check_scene(valve(), 1500, 200);
}

TEST_CASE("mixed precision: the bits of the processor on every device") {
  check_scene(shaken_clumps("euler"), 350, 400, true);
  check_scene(valve(), 800, 20, true);
}

TEST_CASE("fast arithmetic: other last digits, the same motion") {
  SimulationOptions fast = on("opencl"), exact = on("cpu");
  fast.fast = true;
  if (test_devices().size() < 3) return;
  Simulation a(sphere_bed("euler"), exact), b(sphere_bed("euler"), fast);
  CHECK(b.fast());
  CHECK(!a.fast());
  advance(a, 200);
  advance(b, 200);
  const Particles &p = a.world().particles(), &q = b.world().particles();
  double off = 0, moved = 0;
  for (std::size_t k = 0; k < p.count(); ++k) {
    off = std::max(off, norm(position(p.body[k]) - position(q.body[k])));
    moved = std::max(moved, norm(velocity(p.body[k])) * 2e-3);
  }
  MESSAGE("largest difference " << off << " m of " << moved << " m moved");
  CHECK(off < 1e-6 * moved);
}

TEST_CASE("a checkpoint goes on with on another device, to the same bits") {
  const CaseFile file = valve();
  Simulation reference(file, on("cpu"));
  advance(reference, 1600);
  const Outcome expected = outcome(reference);
  auto sim = std::make_unique<Simulation>(file, on("cpu"));
  advance(*sim, 400);
  std::vector<std::string> order = test_devices();
  order.push_back("cpu");
  for (const std::string& device : order) {
    MemoryState state;
    sim->save(state);
    sim = std::make_unique<Simulation>(file, on(device));
    sim->load(state);
    advance(*sim, 1200 / static_cast<int>(order.size()));
  }
  advance(*sim, 1200 % static_cast<int>(order.size()));
  check_same(outcome(*sim), expected);
}

TEST_CASE("what a device cannot do runs on the processor, and says so before the run starts") {
  CaseFile resting = sphere_bed("euler");
  resting.settings.rest.on = true;
  Simulation sim(resting, on("host"));
  CHECK(sim.device() == "cpu, because of 1 obstacle to devices: particles at rest (/rest) are not there on devices");
  const auto messages = sim.take_messages();
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].find("--device host: runs on the cpu") != std::string::npos);
}

TEST_CASE("sources, drag and particles that leave: the bits of the processor on every device") {
  check_scene(pouring("verlet"), 900, 150);
  check_scene(pouring("euler"), 900, 150);
}

TEST_CASE("between looks nothing comes back from a device but flags, and numbers for the size of lists") {
  for (const std::string& device : test_devices()) {
    CAPTURE(device);
    Simulation sim(sphere_bed("euler"), on(device));
    advance(sim, 10);
    const Simulation::Counters before = sim.counters();
    advance(sim, 160);
    // counters() looks at the totals: 14 sums, 6 loads of one part, 2 more.
    const std::uint64_t totals = 22 * sizeof(double);
    const Simulation::Counters after = sim.counters();
    const std::uint64_t rebuilds = after.rebuilds - before.rebuilds, batches = 160 / 16 + rebuilds;
    CHECK(rebuilds >= 3);
    // Seven flags for each batch. For lists: a box and the classes of reach, the bits of Morton keys, and four counts.
    const std::uint64_t most = batches * 28 + rebuilds * (64 + 32 * 4 + 8 + 4 + 8 + 8) + totals;
    CHECK(after.bytes_fetched - before.bytes_fetched <= most);
    CHECK(most < 3000 * sizeof(Record) / 50);
  }
}

namespace {

/// Sizes from 1 to 8 in a periodic box, so that spheres stand in several levels, and one sphere far from all others, so
/// that cells of the finest level share numbers.
CaseFile mixture(const std::string& integrator) {
  CaseText c;
  c.gravity = "[1, 0, -9.81]";
  c.domain = R"({"min": [0, 0, -0.01], "max": [0.05, 0.05, 30], "periodic": [true, true, false]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 5e-6, "end": 10})";
  c.more = R"("energy": true)";
  c.parts = R"([{"name": "floor", "geometry": "calx.plane", "material": "sand",
                 "parameters": {"point": [0.025, 0.025, 0], "half_u": 0.2, "half_v": 0.2}}])";
  CaseFile file = c.file();
  const auto sized = [&](double scale, std::size_t count, std::size_t side, double low, double down) {
    std::vector<Given> all =
        lattice(count, side, side, 2.1e-3 * scale, {0, 0, low}, 4e-5 * scale, 0.4, static_cast<std::uint64_t>(scale));
    for (Given& g : all) g.v.z -= down;
    SourceSettings s = given_source("ball", all);
    s.size.scale = scale;
    file.settings.sources.push_back(s);
  };
  sized(1, 900, 22, 2e-4, 0);
  sized(2, 150, 11, 5e-3, 0.5);
  sized(8, 8, 2, 1.4e-2, 1);
  file.settings.sources.push_back(given_source("ball", {{{0.02, 0.02, 29}, {}, {}, {}}}));
  return file;
}

}  // namespace

TEST_CASE("sizes from 1 to 8 across periodic faces: the lists and bits of the processor on every device") {
  check_scene(mixture("euler"), 500, 100);
  check_scene(mixture("verlet"), 300, 60);
}

TEST_CASE("events, stages and the end of a run come in the same step on a device") {
  CaseFile file = pouring("euler");
  Simulation reference(file, on("cpu"));
  std::vector<std::string> expected;
  const auto collect = [](Simulation& sim, std::vector<std::string>& all) {
    for (int k = 0; k < 800; k += static_cast<int>(sim.step(static_cast<std::uint64_t>(800 - k))))
      for (auto& m : sim.take_messages()) all.push_back(std::to_string(sim.step_count()) + " " + m);
  };
  for (int k = 0; k < 800; ++k) {
    reference.step();
    for (auto& m : reference.take_messages()) expected.push_back(m);
  }
  CHECK(expected.size() >= 3);
  Simulation sim(file, on("host"));
  std::vector<std::string> found;
  collect(sim, found);
  REQUIRE(found.size() == expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) CHECK(found[k].substr(found[k].find(' ') + 1) == expected[k]);
}

TEST_CASE("a guard stops a run in the same step and words on a device") {
  const auto words = [](const std::string& device, const CaseFile& file, std::uint64_t& steps) {
    Simulation sim(file, on(device));
    std::string text;
    try {
      advance(sim, 4000);
    } catch (const Error& e) {
      text = e.what();
    }
    steps = sim.step_count();
    return text;
  };
  CaseFile pressed = sphere_bed("euler");
  pressed.settings.overlap_limit = 0.05;
  CaseText open;
  open.domain = R"({"min": [-0.01, -0.01, -0.01], "max": [0.01, 0.01, 0.01]})";
  const CaseFile lost = with_given(open, "ball", {{{0, 0, 0}, {1, 0.2, 0}, {}, {}}, {{0, 0.005, 0}, {}, {}, {}}});
  for (const CaseFile& file : {pressed, lost}) {
    std::uint64_t steps = 0, other = 0;
    const std::string expected = words("cpu", file, steps);
    CHECK(expected.find("run stopped at t = ") == 0);
    CHECK(steps > 10);
    for (const std::string& device : test_devices()) {
      CAPTURE(device);
      CHECK(words(device, file, other) == expected);
      CHECK(other == steps);
    }
  }
}
