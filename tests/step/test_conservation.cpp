// Momentum, angular momentum and the energy ledger of many particles.
#include <doctest/doctest.h>

#include <cmath>

#include "support/case.hpp"

using namespace calx;

namespace {

const char* const kHertz = R"({"law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0.4,
  "rolling": "epsd2", "rolling_friction": 0.1, "tangential": "rescaled"}})";
const char* const kEpam = R"({"law": "calx.epam", "parameters": {"restitution": 0.4, "friction": 0.5, "plasticity": 0.4,
  "surface_energy": 0.2, "rolling": "epsd", "rolling_friction": 0.1, "tangential": "rescaled"}})";

std::string contact(const std::string& a, const std::string& b, std::string law) {
  return "{\"between\": [\"" + a + "\", \"" + b + "\"], " + law.substr(1);
}

/// A ball of particles flying towards its middle and turning as a whole, far from any wall.
CaseFile implosion(const std::string& shape, const std::string& law, const std::string& integrator) {
  CaseText c;
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 1e-5, "end": 10})";
  c.contacts = "[" + contact("sand", "sand", law) + "]";
  // Wide enough for the largest shape in any turn.
  const double pitch = shape == "ball" ? 2.2e-3 : 3.2e-3;
  auto particles = lattice(900, 10, 10, pitch, {0.1, 0.2, 0.3}, 5e-5, 0.3);
  const Vec3 middle = Vec3{0.1, 0.2, 0.3} + pitch * Vec3{5, 5, 4.5};
  for (auto& p : particles) {
    const Vec3 d = p.x - middle;
    p.v += Vec3{1, 0.5, -0.2} - 60 * d + cross(Vec3{10, 30, 20}, d);
  }
  return with_given(c, shape, particles);
}

/// 300 grains dropped into a box.
CaseFile pile(const std::string& shape, const std::string& law, const std::string& integrator,
              const std::string& extra) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.domain = R"({"min": [-0.02, -0.02, -0.02], "max": [0.1, 0.1, 0.3]})";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 5e-6, "end": 10})";
  c.materials =
      R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}, "steel": {"density": 7800, "young": 1e8, "poisson": 0.25}})";
  c.contacts = "[" + contact("sand", "sand", law) + "," + contact("sand", "steel", law) + "]";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "steel")" + extra + R"(,
                 "parameters": {"min": [0, 0, 0], "max": [0.022, 0.022, 0.2], "open_top": "yes"}}])";
  c.more = "\"energy\": true";
  if (!extra.empty())
    c.more += R"(, "motions": {"shake": {"plugin": "calx.vibration", "parameters": {"direction": [0, 0, 1],
                  "amplitude": 2e-4, "frequency": 60}}})";
  auto grains = lattice(300, 7, 7, 2.8e-3, {1e-3, 1e-3, 5e-4}, 5e-5, 0.1);
  for (auto& g : grains) g.v.z -= 0.6;
  return with_given(c, shape, grains);
}

}  // namespace

TEST_CASE("particles alone keep momentum and angular momentum to rounding") {
  for (const char* shape : {"ball", "odd"})
    for (const char* law : {kHertz, kEpam})
      for (const std::string integrator : {"euler", "verlet"}) {
        CAPTURE(std::string(shape));
        CAPTURE(std::string(law));
        CAPTURE(integrator);
        Simulation sim(implosion(shape, law, integrator), test_options());
        sim.step();
        const Totals start = totals(sim);
        advance(sim, 400);
        const Totals end = totals(sim);
        CHECK(sim.counters().touching > 50);
        CHECK(end.kinetic < 0.95 * start.kinetic);
        CHECK(norm(end.momentum - start.momentum) < 1e-13 * start.impulse_scale);
        // Angular momentum about the origin, 0.4 m away. Contact forces act along x(n), at which euler has them
        // exactly.
        CHECK(norm(end.angular_momentum - start.angular_momentum) < 1e-12 * 0.4 * start.impulse_scale);
      }
}

TEST_CASE("the energy ledger of a dropped pile closes within 1 percent") {
  for (const char* law : {kHertz, kEpam})
    for (const std::string integrator : {"euler", "verlet"}) {
      // Each law and integrator with spheres once and with clumps once.
      const std::string shape = (law == kHertz) == (integrator == "euler") ? "ball" : "grain";
      CAPTURE(shape);
      CAPTURE(std::string(law));
      CAPTURE(integrator);
      Simulation sim(pile(shape, law, integrator, ""), test_options());
      advance(sim, 9000);
      const EnergyLedger e = sim.world().energy();
      CHECK(e.kept);
      CHECK(sim.counters().touching > 200);
      CHECK(e.friction > 0.05 * e.work_done);
      CHECK(e.damping > 0.05 * e.work_done);
      CHECK(e.wall_work == 0);
      CHECK(std::fabs(e.remainder) < 0.01 * e.work_done);
      // The parts of the ledger are what they say.
      const Particles& p = sim.world().particles();
      double potential = 0, kinetic = 0;
      for (std::size_t k = 0; k < p.count(); ++k) {
        potential += p.mass(k) * 9.81 * p.body[k].z;
        kinetic += p.kinetic_energy(k);
      }
      CHECK(e.gravity == doctest::Approx(potential).scale(0).epsilon(1e-3));
      CHECK(e.kinetic_translation + e.kinetic_rotation == doctest::Approx(kinetic).scale(0).epsilon(0.05));
    }
}

TEST_CASE("the ledger of one impact closes to second order in the step, for both integrators") {
  for (const std::string integrator : {"euler", "verlet"}) {
    double remainder[2];
    for (int k = 0; k < 2; ++k) {
      CaseText c;
      c.time = R"({"integrator": ")" + integrator + R"(", "step": )" + (k == 0 ? "8e-6" : "2e-6") + R"(, "end": 10})";
      c.contacts = "[" + contact("sand", "sand", kHertz) + "]";
      c.more = "\"energy\": true";
      remainder[k] = 0;
      // Impacts that begin at different shares of a step.
      for (int m = 0; m < 10; ++m) {
        Simulation sim(with_given(c, "ball", {{{}, {}, {}, {}}, {{0.00202 + 1e-6 * m, 0.0006, 0}, {-1, 0, 0}, {}, {}}}),
                       test_options());
        while (sim.time() < 1e-3) sim.step();
        CHECK(totals(sim).kinetic < 0.8 * sim.world().energy().inserted);
        remainder[k] += std::fabs(sim.world().energy().remainder) / sim.world().energy().inserted / 10;
      }
    }
    CHECK(remainder[0] < 2e-3);
    CHECK(remainder[1] < remainder[0] / 8);
  }
}

TEST_CASE("the ledger counts the work of drag") {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.more = R"("energy": true, "forces": [{"plugin": "calx.stokes-drag", "parameters": {"viscosity": 0.01}}])";
  for (const char* integrator : {"euler", "verlet"}) {
    c.time = R"({"integrator": ")" + std::string(integrator) + R"(", "step": 2e-5, "end": 10})";
    Simulation sim(with_given(c, "ball", {{{}, {1, 0, 0}, {}, {}}}), test_options());
    advance(sim, 5000);
    const EnergyLedger e = sim.world().energy();
    const double m = sim.world().particles().mass(0), rate = 6 * 3.14159265358979 * 0.01 * 1e-3 / m;
    CHECK(body_of(sim, 0).vx == doctest::Approx(std::exp(-rate * 0.1)).scale(0).epsilon(1e-3));
    CHECK(e.force_work < -0.3 * e.work_done);
    CHECK(std::fabs(e.remainder) < 1e-4 * e.work_done);
  }
}

TEST_CASE("the ledger counts the work of a shaken box") {
  Simulation sim(pile("grain", kHertz, "euler", R"(, "motion": "shake")"), test_options());
  advance(sim, 8000);
  const EnergyLedger e = sim.world().energy();
  CHECK(std::fabs(e.wall_work) > 0.02 * e.work_done);
  CHECK(std::fabs(e.remainder) < 0.01 * e.work_done);
}
