// Beds at rest are left out of the steps, and go on as if they had not been as soon as something disturbs them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/scenes.hpp"
#include "support/memory_state.hpp"

using namespace calx;

namespace {

/// Steps until the bed rests.
constexpr int kSettled = 24000;

struct Bin {
  std::string integrator = "euler", shape = "ball", rest, more;  // rest: "" or "{...}"
  std::string plug;                                              // further keys of the part
  bool shot = false;  // a ball of twice the size hits the bed just after kSettled
};

/// Balls or clumps fall into a bin of 20 mm x 20 mm; its floor at z = 0 has a strip of 10 mm in the middle, the plug,
/// and 60 mm below it the bin has its bottom.
CaseFile bin(const Bin& b) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.02, -0.02, -0.07], "max": [0.04, 0.04, 0.2]})";
  c.time = R"({"integrator": ")" + b.integrator + R"(", "step": 1.5e-5, "end": 10})";
  if (b.shot)
    c.sources = R"([{"name": "shot", "shape": "ball", "material": "sand", "count": 1, "when": {"time": 0.3601},
      "size": {"scale": 2}, "velocity": [0, 0, -1.2], "region": {"box": {"min": [0.007, 0.007, 0.02], "max": [0.013, 0.013, 0.026]}}}])";
  c.parts = R"([{"name": "bin", "geometry": "calx.box", "material": "sand",
                 "parameters": {"min": [0, 0, -0.06], "max": [0.02, 0.02, 0.15]}},
    {"name": "left", "geometry": "calx.plane", "material": "sand",
     "parameters": {"point": [0.0025, 0.01, 0], "half_u": 0.0025, "half_v": 0.01}},
    {"name": "right", "geometry": "calx.plane", "material": "sand",
     "parameters": {"point": [0.0175, 0.01, 0], "half_u": 0.0025, "half_v": 0.01}},
    {"name": "plug", "geometry": "calx.plane", "material": "sand", )" +
            b.plug + R"(
     "parameters": {"point": [0.01, 0.01, 0], "half_u": 0.005, "half_v": 0.01}}])";
  c.more =
      R"("energy": true)" + (b.rest.empty() ? "" : ", \"rest\": " + b.rest) + (b.more.empty() ? "" : ", " + b.more);
  const bool ball = b.shape == "ball";
  return with_given(c, b.shape,
                    ball ? lattice(600, 8, 8, 2.3e-3, {4e-4, 4e-4, 4e-4}, 5e-5, 0.3)
                         : lattice(400, 7, 7, 2.75e-3, {3e-4, 3e-4, 4e-4}, 4e-5, 0.3));
}

double weight(const Simulation& sim) { return totals(sim).mass * 9.81; }
double floor_force(const Simulation& sim) {
  double sum = 0;
  for (std::size_t k = 0; k < sim.world().part_count(); ++k) sum -= sim.world().part_load(k).force.z;
  return sum;
}
Vec3 centre_of_mass(const Simulation& sim) {
  Vec3 sum;
  for (const Record& b : sim.world().particles().body) sum += b.m * position(b);
  return sum / totals(sim).mass;
}

/// The bed with rest on when it has settled, and a copy that goes on with rest off.
struct Both {
  std::unique_ptr<Simulation> on, off;
  explicit Both(Bin b, const SimulationOptions& options = test_options(1)) {
    b.rest = "{}";
    on = std::make_unique<Simulation>(bin(b), options);
    advance(*on, kSettled);
    MemoryState state;
    on->save(state);
    b.rest = "";
    off = std::make_unique<Simulation>(bin(b), options);
    off->load(state);
  }
  void go(int steps) {
    advance(*on, steps);
    advance(*off, steps);
  }
};

std::size_t below(const Simulation& sim, double z) {
  std::size_t n = 0;
  for (const Record& b : sim.world().particles().body) n += b.z < z;
  return n;
}

/// Threads and stops of a run that goes on from a bed at rest: one digest.
void check_same_bits(const Bin& b, bool mixed, int steps) {
  auto options = test_options(1);
  options.mixed = mixed;
  Simulation bed(bin(b), options);
  advance(bed, kSettled);
  CHECK(bed.counters().asleep > bed.world().particles().count() * 9 / 10);
  MemoryState settled;
  bed.save(settled);
  advance(bed, steps);
  CHECK(bed.counters().asleep < bed.world().particles().count() * 9 / 10);
  const int last = 20;
  advance(bed, last);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    auto sim = std::make_unique<Simulation>(bin(b), options);
    sim->load(settled);
    for (int done = 0, stop = steps / 5 + threads; done < steps;
         done = stop, stop = std::min(steps, stop + steps / 3)) {
      advance(*sim, stop - done);
      MemoryState state, again;
      sim->save(state);
      sim = std::make_unique<Simulation>(bin(b), options);
      sim->load(state);
      sim->save(again);
      CHECK(again.doubles == state.doubles);
      CHECK(again.u8 == state.u8);
      CHECK(again.u64 == state.u64);
    }
    advance(*sim, last);
    CAPTURE(threads);
    CHECK(sim->digest() == bed.digest());
    CHECK(sim->counters().asleep == bed.counters().asleep);
    CHECK(sim->counters().touching == bed.counters().touching);
    CHECK(sim->world().energy().remainder == bed.world().energy().remainder);
    for (std::size_t k = 0; k < bed.world().part_count(); ++k)
      CHECK(norm(sim->world().part_load(k).force - bed.world().part_load(k).force) == 0);
  }
}

}  // namespace

TEST_CASE("a settled bed falls asleep, stays where it is and weighs what it weighs") {
  for (const char* integrator : {"euler", "verlet"}) {
    Bin b;
    b.integrator = integrator;
    Both bed(b);
    CHECK(bed.on->counters().asleep > 550);
    CHECK(bed.off->counters().asleep == 0);
    const auto ranks = ranks_by_id(*bed.on);
    const Particles before = bed.on->world().particles();
    bed.go(2000);
    const auto ranks_now = ranks_by_id(*bed.on);
    std::size_t moved = 0;
    for (const auto& [id, rank] : ranks)
      moved += norm(position(bed.on->world().particles().body[ranks_now.at(id)]) - position(before.body[rank])) > 0;
    CHECK(moved < 50);
    // The forces that are left out are at most a tenth of the weight; here 1e-4 of it was seen.
    CHECK(floor_force(*bed.on) == doctest::Approx(weight(*bed.on)).epsilon(2e-3));
    CHECK(bed.on->counters().touching ==
          doctest::Approx(static_cast<double>(bed.off->counters().touching)).epsilon(0.01));
    const EnergyLedger on = bed.on->world().energy(), off = bed.off->world().energy();
    CHECK(on.elastic == doctest::Approx(off.elastic).epsilon(0.01));
    // The ledger closes as well as without.
    CHECK(std::fabs(on.remainder - off.remainder) < 1e-3 * off.work_done);
  }
}

TEST_CASE("rest that never comes and no rest give the same bits") {
  Bin b;
  Simulation off(bin(b), test_options(1));
  b.rest = R"({"displacement": 1e-300})";
  Simulation on(bin(b), test_options(2));
  advance(off, 3000);
  advance(on, 3000);
  CHECK(on.digest() == off.digest());
  CHECK(on.counters().asleep == 0);
}

TEST_CASE("a ball dropped on a sleeping bed wakes what it hits, and the crater is that of a bed awake") {
  Bin b;
  b.shot = true;
  Both bed(b);
  CHECK(bed.on->counters().asleep > 550);
  bed.go(3000);
  // The blow is felt.
  CHECK(bed.on->counters().asleep < 400);
  const std::uint32_t ball = 600;
  const double radius = 2e-3;
  CHECK(norm(position(body_of(*bed.on, ball)) - position(body_of(*bed.off, ball))) < 0.1 * radius);
  CHECK(norm(centre_of_mass(*bed.on) - centre_of_mass(*bed.off)) < 0.01 * radius);
}

TEST_CASE("a hole opened below a sleeping bed drains it") {
  Bin b;
  b.plug = R"("vanishes": {"time": 0.3601},)";
  Both bed(b);
  CHECK(bed.on->counters().asleep > 550);
  bed.go(6000);
  CHECK(below(*bed.off, -1e-3) > 100);
  CHECK(static_cast<double>(below(*bed.on, -1e-3)) ==
        doctest::Approx(static_cast<double>(below(*bed.off, -1e-3))).epsilon(0.1));
  CHECK(centre_of_mass(*bed.on).z == doctest::Approx(centre_of_mass(*bed.off).z).epsilon(0.1));
}

TEST_CASE("a plate that goes down or up takes the bed with it") {
  for (const char* way : {"[0, 0, -0.01]", "[0, 0, 0.005]"}) {
    Bin b;
    b.plug = R"("motion": "go",)";
    b.more = std::string(R"("motions": {"go": {"plugin": "calx.travel", "start": {"time": 0.3601},
      "parameters": {"displacement": )") +
             way + R"(, "duration": 0.05}}})";
    Both bed(b);
    CHECK(bed.on->counters().asleep > 550);
    const double start = centre_of_mass(*bed.on).z;
    bed.go(5000);
    CAPTURE(way);
    CHECK(std::fabs(centre_of_mass(*bed.off).z - start) > 5e-4);
    CHECK(std::fabs(centre_of_mass(*bed.on).z - centre_of_mass(*bed.off).z) < 1e-4);
  }
}

TEST_CASE("a disturbed bed at rest: one digest for every number of threads and after restarts") {
  Bin b;
  b.shot = true;
  b.rest = "{}";
  check_same_bits(b, false, 800);
  check_same_bits(b, true, 800);
  b.integrator = "verlet";
  b.shape = "grain";
  b.shot = false;
  b.rest = R"({"force": 0.3})";
  b.plug = R"("vanishes": {"time": 0.3601},)";
  check_same_bits(b, false, 800);
}
