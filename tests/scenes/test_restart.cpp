// A run saved at any step and gone on with in a new simulation equals the straight run to the bit.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "scenes/scenes.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

void check_equal(const Simulation& a, const Simulation& b) {
  CHECK(a.digest() == b.digest());
  CHECK(a.step_count() == b.step_count());
  const auto mass_a = a.world().mass(), mass_b = b.world().mass();
  CHECK(mass_a.inserted_count == mass_b.inserted_count);
  CHECK(mass_a.removed_count == mass_b.removed_count);
  CHECK(mass_a.delivered == mass_b.delivered);
  const auto e = a.world().energy(), f = b.world().energy();
  CHECK(e.friction == f.friction);
  CHECK(e.wall_work == f.wall_work);
  CHECK(e.remainder == f.remainder);
  for (std::size_t k = 0; k < a.world().part_count(); ++k) {
    CHECK(a.world().part_present(k) == b.world().part_present(k));
    CHECK(norm(a.world().part_load(k).force - b.world().part_load(k).force) == 0);
  }
  CHECK(a.counters().largest_overlap == b.counters().largest_overlap);
  CHECK(a.counters().rebuilds == b.counters().rebuilds);
}

/// Saves at the steps given, each time going on in a new simulation; the number of threads changes on the way.
void check_restarts(const CaseFile& file, int threads, int steps, const std::vector<int>& stops) {
  Simulation straight(file, test_options(1));
  advance(straight, steps);
  auto sim = std::make_unique<Simulation>(file, test_options(threads));
  int done = 0;
  for (const int stop : stops) {
    advance(*sim, stop - done);
    done = stop;
    MemoryState state;
    sim->save(state);
    sim = std::make_unique<Simulation>(file, test_options(stop % 2 == 0 ? 1 : threads));
    sim->load(state);
    MemoryState again;
    sim->save(again);
    // What was loaded is saved alike, but for lists no result depends on.
    CHECK(again.doubles == state.doubles);
    CHECK(again.u32 == state.u32);
    CHECK(again.u64 == state.u64);
    CHECK(again.u8 == state.u8);
    CHECK(again.text == state.text);
  }
  advance(*sim, steps - done);
  check_equal(straight, *sim);
}

std::vector<int> random_stops(std::uint64_t seed, int steps) {
  Random r(seed, 5);
  std::vector<int> out;
  for (int k = 0; k < 3; ++k) out.push_back(1 + static_cast<int>((k + r.uniform()) * steps / 3.0));
  return out;
}

}  // namespace

TEST_CASE("a bed of spheres goes on from a checkpoint to the bit") {
  for (const char* integrator : {"euler", "verlet"})
    check_restarts(sphere_bed(integrator), 3, 300, random_stops(1, 298));
}

TEST_CASE("shaken cohesive clumps in a periodic box go on from a checkpoint to the bit") {
  for (const char* integrator : {"euler", "verlet"})
    check_restarts(shaken_clumps(integrator), 2, 250, random_stops(2, 248));
}

TEST_CASE("sources by rate, events, motions, vanishing parts and losses go on from a checkpoint to the bit") {
  for (const char* integrator : {"euler", "verlet"}) {
    const CaseFile file = pouring(integrator);
    Simulation straight(file, test_options());
    advance(straight, 1500);
    // The scene must mean something: the rain is over only later, some are lost, the fence is gone.
    CHECK(straight.world().mass().removed_count > 5);
    CHECK(straight.world().mass().inserted_count > 150);
    CHECK_FALSE(straight.world().part_present(1));
    CHECK(straight.counters().touching > 50);
    CHECK(straight.world().energy().force_work < 0);
    for (const std::uint64_t seed : {1, 2, 3}) check_restarts(file, 1, 900, random_stops(seed, 898));
    // Before the first step, after the first, and at the steps where things happen.
    check_restarts(file, 1, 700, {0, 1, 2, 199, 200, 201, 300, 301, 400, 401, 600, 601, 602});
  }
}

TEST_CASE("a simulation that has run already takes a checkpoint as a new one does") {
  const CaseFile file = sphere_bed("euler");
  Simulation straight(file, test_options()), used(file, test_options());
  advance(straight, 60);
  MemoryState state;
  straight.save(state);
  advance(used, 150);
  used.load(state);
  advance(used, 60);
  advance(straight, 60);
  check_equal(straight, used);
}

TEST_CASE("a checkpoint of another case is refused, and says why") {
  Simulation sim(sphere_bed("euler"), test_options(1));
  advance(sim, 3);
  MemoryState state;
  sim.save(state);
  CaseFile other = sphere_bed("euler");
  other.settings.time.step = 9e-6;
  Simulation slower(other, test_options(1));
  CHECK_THROWS_WITH_AS(slower.load(state), doctest::Contains("time step"), Error);
  other = sphere_bed("euler");
  other.settings.contacts[0].laws[0].law = "calx.epam";
  other.settings.contacts[0].laws[0].parameters.json = R"({"restitution": 0.5, "friction": 0.4, "plasticity": 0.4})";
  Simulation plastic(other, test_options(1));
  CHECK_THROWS_WITH_AS(plastic.load(state), doctest::Contains("written by other laws"), Error);
  other = sphere_bed("euler");
  other.settings.parts.clear();
  Simulation open(other, test_options(1));
  CHECK_THROWS_WITH_AS(open.load(state), doctest::Contains("written with 1 parts, this case has 0"), Error);
}
