// Periodic boxes: weight, wrapping, energy, and boxes that are too small.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.hpp"
#include "support/case.hpp"

using namespace calx;

TEST_CASE("a periodic bed settles and its weight is the force on the floor") {
  for (const char* shape : {"ball", "grain"}) {
    CaseText c;
    c.gravity = "[0, 0, -9.81]";
    c.domain = R"({"min": [0, 0, -0.01], "max": [0.0135, 0.0108, 0.2], "periodic": [true, true, false]})";
    c.time = R"({"step": 1.2e-5, "end": 10})";
    c.materials = R"({"sand": {"density": 2000, "young": 2e6, "poisson": 0.25}})";
    c.contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                      "parameters": {"restitution": 0.2, "friction": 0.5, "rolling": "epsd2", "rolling_friction": 0.1}}])";
    c.parts =
        R"([{"name": "floor", "geometry": "calx.plane", "material": "sand", "parameters": {"half_u": 0.1, "half_v": 0.1}}])";
    Simulation sim(with_given(c, shape, lattice(160, 5, 4, 2.7e-3, {0, 0, 1e-4}, 5e-5, 0.2)), test_options());
    advance(sim, 25000);
    const Totals t = totals(sim);
    Vec3 force;
    for (int k = 0; k < 500; ++k) {
      sim.step();
      force += sim.world().part_load(0).force / 500;
    }
    CHECK(-force.z == doctest::Approx(9.81 * t.mass).scale(0).epsilon(0.005));
    // At rest: less than a rise by a thousandth of the diameter.
    CHECK(t.kinetic < t.mass * 9.81 * 2e-6);
    const Particles& p = sim.world().particles();
    CHECK(p.count() == 160);
    double top = 0;
    for (const auto& b : p.body) {
      CHECK(b.x > -0.003);
      CHECK(b.x < 0.0165);
      top = std::max(top, b.z);
    }
    // 160 particles at a solid fraction of about 0.58.
    CHECK(top > 0.006);
    CHECK(top < 0.022);
  }
}

TEST_CASE("particles touch across a periodic face as they do inside") {
  for (const char* shape : {"ball", "odd"})
    for (int axis = 0; axis < 3; ++axis) {
      auto scene = [&](double middle) {
        CaseText c;
        c.domain = R"({"min": [0, 0, 0], "max": [0.02, 0.02, 0.02], "periodic": [true, true, true]})";
        Given a{{0.01, 0.01, 0.01}, {}, {10, 20, 30}, {}}, b = a;
        a.x[axis] = middle - 0.0022;
        b.x[axis] = middle + 0.0022;
        for (Given* g : {&a, &b}) {
          if (g->x[axis] < 0) g->x[axis] += 0.02;
          if (g->x[axis] >= 0.02) g->x[axis] -= 0.02;
        }
        a.v[axis] = 1;
        b.v[axis] = -0.5;
        return with_given(c, shape, {a, b});
      };
      Simulation inside(scene(0.01), test_options()), across(scene(0.0199), test_options());
      double largest = 0;
      for (int k = 0; k < 1500; ++k) {
        inside.step();
        across.step();
      }
      largest = inside.counters().largest_overlap;
      CHECK(largest > 0.01);
      CHECK(across.counters().largest_overlap == doctest::Approx(largest).scale(0).epsilon(1e-9));
      for (std::uint32_t id = 0; id < 2; ++id) {
        CHECK(norm(velocity(body_of(inside, id)) - velocity(body_of(across, id))) < 1e-9);
        CHECK(norm(spin(body_of(inside, id)) - spin(body_of(across, id))) < 1e-6);
      }
    }
}

TEST_CASE("the energy ledger stays closed while gravity drives particles round and round") {
  CaseText c;
  c.gravity = "[5, 0, 0]";
  c.domain = R"({"min": [0, 0, 0], "max": [0.02, 0.02, 0.02], "periodic": [true, false, false]})";
  c.more = "\"energy\": true";
  for (const char* shape : {"ball", "grain"}) {
    Simulation sim(with_given(c, shape, {{{0.01, 0.01, 0.01}, {0.5, 0, 0}, {}, {}}}), test_options());
    advance(sim, 20000);
    const EnergyLedger e = sim.world().energy();
    CHECK(body_of(sim, 0).vx == doctest::Approx(1.5).epsilon(1e-6));
    CHECK(std::fabs(e.remainder) < 1e-4 * e.work_done);
  }
}

TEST_CASE("a periodic box in which a particle could meet itself or another twice is refused") {
  CaseText c;
  c.domain = R"({"min": [0, 0, 0], "max": [0.003, 0.02, 0.02], "periodic": [true, false, false]})";
  Simulation sim(with_given(c, "ball", {{{0.001, 0.01, 0.01}, {}, {}, {}}}), test_options());
  CHECK_THROWS_WITH_AS(
      sim.step(),
      doctest::Contains("/domain: periodic along x over 0.003 m; particles up to 0.002 m across need at least 0.008 m"),
      Error);
}
