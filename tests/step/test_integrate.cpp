// Free flight and free rotation.
#include <doctest/doctest.h>

#include <cmath>

#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

CaseText free_space(const std::string& integrator, const std::string& step, const std::string& gravity = "[0, 0, 0]") {
  CaseText c;
  c.gravity = gravity;
  c.domain = R"({"min": [-100, -100, -100], "max": [100, 100, 100]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": )" + step + R"(, "end": 1000})";
  return c;
}

}  // namespace

TEST_CASE("a thrown particle follows the parabola: verlet exactly, euler half a step ahead") {
  const double dt = 2e-5, g = 9.81;
  const int steps = 5000;
  for (const char* shape : {"ball", "odd"})
    for (const std::string integrator : {"euler", "verlet"}) {
      const Vec3 x0{1, 2, 3}, v0{0.5, -1, 2};
      Simulation sim(with_given(free_space(integrator, "2e-5", "[0, 0, -9.81]"), shape, {{x0, v0, {}, {}}}),
                     test_options());
      advance(sim, steps);
      const double t = sim.time();
      CHECK(t == near(steps * dt, 1e-14));
      const Record& b = body_of(sim, 0);
      const double lead = integrator == "euler" ? 0.5 * g * t * dt : 0;
      CHECK(b.x == near(1 + 0.5 * t, 1e-12));
      CHECK(b.y == near(2 - t, 1e-12));
      CHECK(b.z == near(3 + 2 * t - 0.5 * g * t * t - lead, 1e-12));
      CHECK(b.vz == near(2 - g * t, 1e-11));
      CHECK(b.wx == 0);
    }
}

TEST_CASE("a tumbling asymmetric clump keeps energy and angular momentum over 10 000 steps") {
  for (const char* integrator : {"euler", "verlet"}) {
    // Spin mostly about the middle axis, the unstable one; 0.01 rad a step.
    const Given g{{0, 0, 0}, {0.3, 0, 0}, {30, 500, 20}, normalized(Quat{0.9, 0.3, -0.2, 0.1})};
    Simulation sim(with_given(free_space(integrator, "2e-5"), "odd", {g}), test_options());
    sim.step();
    const Particles& p = sim.world().particles();
    const Vec3 i = p.inertia(0);
    CHECK(i.z / i.x > 1.2);
    CHECK(i.y / i.x > 1.05);
    const Totals start = totals(sim);
    double lowest = 1e300, highest = 0, tilt = 1;
    const Vec3 axis0 = rotate(p.turn[0], {0, 1, 0});
    for (int k = 0; k < 10000; ++k) {
      sim.step();
      const double e = p.kinetic_energy(0);
      lowest = std::min(lowest, e);
      highest = std::max(highest, e);
      tilt = std::min(tilt, dot(axis0, rotate(p.turn[0], {0, 1, 0})));
    }
    const Totals end = totals(sim);
    CHECK(tilt < -0.5);  // it did turn over
    CHECK(norm(end.angular_momentum - start.angular_momentum) < 1e-11 * norm(start.angular_momentum));
    CHECK((highest - lowest) / start.kinetic < 1e-4);
    CHECK(std::fabs(end.kinetic - start.kinetic) < 1e-4 * start.kinetic);
    CHECK(norm(end.momentum - start.momentum) < 1e-12 * norm(start.momentum));
    const Quat& q = p.turn[0];
    CHECK(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z == near(1, 1e-14));
  }
}

TEST_CASE("the error of energy of a tumbling clump falls with the square of the step") {
  auto spread = [](const std::string& step, int steps) {
    const Given g{{}, {}, {30, 500, 20}, {}};
    Simulation sim(with_given(free_space("euler", step), "odd", {g}), test_options());
    double lowest = 1e300, highest = 0;
    for (int k = 0; k < steps; ++k) {
      sim.step();
      lowest = std::min(lowest, totals(sim).kinetic);
      highest = std::max(highest, totals(sim).kinetic);
    }
    return (highest - lowest) / highest;
  };
  const double coarse = spread("2e-5", 2500), fine = spread("1e-5", 5000);
  CHECK(coarse / fine == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("a symmetric clump precesses at the rate of Euler's equations") {
  // Two equal spheres: the axis turns about L at L / I_t.
  const Given g{{}, {}, {0, 300, 400}, {}};
  Simulation sim(with_given(free_space("verlet", "1e-5"), "grain", {g}), test_options());
  const Particles& p = sim.world().particles();
  sim.step();
  const Vec3 i = p.inertia(0);
  const Totals t0 = totals(sim);
  const Vec3 l = normalized(t0.angular_momentum);
  const double rate = norm(t0.angular_momentum) / i.x;
  auto direction = [&] {
    const Vec3 a = rotate(p.turn[0], {0, 0, 1});
    return normalized(a - dot(a, l) * l);
  };
  const Vec3 from = direction(), across = cross(l, from);
  advance(sim, 3000);
  const Vec3 to = direction();
  const double angle = std::atan2(dot(to, across), dot(to, from)),
               want = std::remainder(rate * 3000e-5, 2 * 3.14159265358979323846);
  CHECK(std::fabs(std::remainder(angle - want, 2 * 3.14159265358979323846)) < 2e-4);
}

TEST_CASE("a given clump stands as it was drawn, turned by its quaternion") {
  const Quat turn = normalized(Quat{0.5, -0.2, 0.7, 0.3});
  for (const char* name : {"grain", "odd"}) {
    Simulation sim(with_given(free_space("euler", "1e-5"), name, {{{1, 2, 3}, {}, {}, turn}}), test_options());
    sim.step();
    const Particles& p = sim.world().particles();
    const auto& drawn = sim.settings().shapes;
    for (const auto& shape : drawn) {
      if (shape.name != name) continue;
      // Positions are those of the centre of mass, so compare differences of members.
      for (std::size_t k = 1; k < shape.spheres.size(); ++k) {
        const Vec3 want = rotate(turn, shape.spheres[k].at - shape.spheres[0].at);
        CHECK(norm(position(p.member[k]) - position(p.member[0]) - want) < 1e-15);
      }
    }
    CHECK(norm(position(p.body[0]) - Vec3{1, 2, 3}) < 1e-15);
  }
}
