// The same bits on every device as on the processor: motion, history, energies, loads.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "compute/device.hpp"
#include "scenes/scenes.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

/// Devices of this machine; CUDA is a stand-in driver unless CALX_TEST_CUDA is "real".
std::vector<std::string> devices() {
  setenv("CALX_CACHE", CALX_TEST_CACHE, 0);
  std::filesystem::create_directories(CALX_TEST_CACHE "/pocl");
  setenv("POCL_CACHE_DIR", CALX_TEST_CACHE "/pocl", 0);
  const char* asked = std::getenv("CALX_TEST_CUDA");
  if (!asked || std::string(asked) != "real") {
    setenv("CALX_LIBCUDA", CALX_STAND_IN_CUDA, 1);
    setenv("CALX_LIBNVRTC", CALX_STAND_IN_NVRTC, 1);
  }
  std::vector<std::string> kinds{"host", "cuda"};
  try {
    open_device("opencl");
    kinds.push_back("opencl");
  } catch (const Error& e) {
    MESSAGE("skipped: " << e.what());
  }
  return kinds;
}

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

void check_scene(const CaseFile& file, int steps) {
  Simulation reference(file, on("cpu"));
  advance(reference, steps);
  const Outcome expected = outcome(reference);
  CHECK(expected.counters.touching > 400);
  CHECK(expected.counters.rebuilds >= 4);
  for (const std::string& device : devices()) {
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
