// The same bits for any number of threads, and run after run.
#include <doctest/doctest.h>

#include "scenes/scenes.hpp"

using namespace calx;

namespace {

struct Outcome {
  std::string digest;
  std::uint64_t touching = 0, rebuilds = 0;
  double kinetic = 0;
  Vec3 load;
};

Outcome outcome(const CaseFile& file, int threads, int steps) {
  Simulation sim(file, test_options(threads));
  advance(sim, steps);
  const auto c = sim.counters();
  return {sim.digest(), c.touching, c.rebuilds, sim.world().energy().kinetic_rotation, sim.world().part_load(0).force};
}

void check_scene(const CaseFile& file, int steps) {
  const Outcome one = outcome(file, 1, steps);
  // The scene must mean something: contacts, several lists, loads.
  CHECK(one.touching > 400);
  CHECK(one.rebuilds >= 4);
  CHECK(norm(one.load) > 0);
  for (const int threads : {1, 2, 3, 8}) {
    CAPTURE(threads);
    const Outcome again = outcome(file, threads, steps);
    CHECK(again.digest == one.digest);
    CHECK(again.kinetic == one.kinetic);
    CHECK(norm(again.load - one.load) == 0);
  }
}

}  // namespace

TEST_CASE("cohesive clumps on a shaken floor in a periodic box: one digest for every number of threads") {
  check_scene(shaken_clumps("euler"), 350);
  check_scene(shaken_clumps("verlet"), 200);
}

TEST_CASE("frictional spheres in a box: one digest for every number of threads") {
  check_scene(sphere_bed("euler"), 350);
  check_scene(sphere_bed("verlet"), 200);
}

TEST_CASE("another start gives another digest") {
  CHECK(outcome(sphere_bed("euler", 1), 2, 20).digest != outcome(sphere_bed("euler", 2), 2, 20).digest);
}
