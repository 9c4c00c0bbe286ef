// Mixed precision beside double: the same figures within what two seeds differ by, and exact where it must be.
#include <doctest/doctest.h>

#include <cmath>

#include "scenes/scenes.hpp"

using namespace calx;

namespace {

SimulationOptions precision(bool mixed) {
  SimulationOptions o = test_options(2);
  o.mixed = mixed;
  return o;
}

/// Spheres poured from a lattice into a box far from the origin of the frame, where a single-precision position would
/// have a grid of 0.1 mm.
CaseFile far_bed(double shift, std::uint64_t seed = 1) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-1, -1, -1], "max": [2000, 1, 1]})";
  c.time = R"({"step": 2e-5, "end": 10})";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "sand",
                 "parameters": {"min": [)" +
            std::to_string(shift) + R"(, 0, 0], "max": [)" + std::to_string(shift + 0.0165) + R"(, 0.0165, 0.2]}}])";
  c.more = R"("energy": true)";
  return with_given(c, "ball", lattice(600, 7, 7, 2.2e-3, {shift + 4e-4, 4e-4, 4e-4}, 5e-5, 0.2, seed));
}

struct Bed {
  double height = 0, kinetic = 0, weight = 0, load = 0, lost = 0, deepest = 0;
};

Bed settle(const CaseFile& file, bool mixed, int steps) {
  Simulation sim(file, precision(mixed));
  advance(sim, steps - 1000);
  Bed out;
  // The last grains still rattle: the mean over 20 ms.
  for (int k = 0; k < 1000; ++k) {
    sim.step();
    out.load -= sim.world().part_load(0).force.z / 1000;
  }
  const Particles& p = sim.world().particles();
  for (std::size_t k = 0; k < p.count(); ++k) {
    out.height += p.body[k].z / static_cast<double>(p.count());
    out.kinetic += p.kinetic_energy(k);
    out.weight += p.mass(k) * 9.81;
  }
  const auto e = sim.world().energy();
  out.lost = e.friction + e.damping;
  out.deepest = sim.counters().largest_overlap;
  return out;
}

}  // namespace

TEST_CASE("mixed precision: a bed of the height, rest and losses of double, as far as two starts agree") {
  const Bed d = settle(far_bed(0), false, 9000), m = settle(far_bed(0), true, 9000),
            other = settle(far_bed(0, 2), false, 9000);
  MESSAGE("height, mm: double " << 1e3 * d.height << ", mixed " << 1e3 * m.height << ", another start "
                                << 1e3 * other.height);
  MESSAGE("energy lost, mJ: double " << 1e3 * d.lost << ", mixed " << 1e3 * m.lost << ", another start "
                                     << 1e3 * other.lost);
  CHECK(std::fabs(m.load / m.weight - 1) < 0.01);
  CHECK(m.kinetic < 1e-8);
  CHECK(d.kinetic < 1e-8);
  // Trajectories part like those of two starts; the scatter of starts is the margin.
  CHECK(std::fabs(m.height - d.height) < 0.02 * d.height);
  CHECK(std::fabs(m.lost - d.lost) < 0.02 * d.lost);
}

TEST_CASE("mixed precision: overlaps do not depend on where the bed stands") {
  // 1024 m is exact in binary, but positions there have steps of 1e-13 m: still far below an overlap of 1e-7 m, where
  // single precision would see 1e-4 m.
  const Bed near = settle(far_bed(0), true, 9000), far = settle(far_bed(1024), true, 9000),
            exact = settle(far_bed(1024), false, 9000);
  MESSAGE("load / weight: near " << near.load / near.weight << ", far " << far.load / far.weight << ", far in double "
                                 << exact.load / exact.weight);
  CHECK(std::fabs(far.load / far.weight - 1) < 0.01);
  CHECK(std::fabs(far.height - near.height) < 0.02 * near.height);
  CHECK(far.deepest < 2 * near.deepest);
}

TEST_CASE("mixed precision: one collision, against double") {
  auto rebound = [](bool mixed) {
    CaseText c;
    c.time = R"({"step": 1e-6, "end": 10})";
    Simulation sim(
        with_given(c, "ball",
                   {{{0, 0, 0}, {0.5, 0.1, 0}, {0, 0, 0}, {}}, {{0.00201, 0.0003, 0}, {-0.5, 0, 0.2}, {0, 30, 0}, {}}}),
        precision(mixed));
    advance(sim, 400);
    return std::make_pair(velocity(sim.world().particles().body[0]), spin(sim.world().particles().body[0]));
  };
  const auto d = rebound(false), m = rebound(true);
  CHECK(d.first.x < 0);
  CHECK(norm(m.first - d.first) < 1e-5 * norm(d.first));
  CHECK(norm(m.second - d.second) < 1e-5 * norm(d.second));
  CHECK(norm(m.first - d.first) > 0);
}
