// Particles, parts and sensors read and written by the program around a simulation.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "cases.hpp"

using calx::embed::Failure;
using calx::embed::Simulation;

namespace {

const char* const kPlate = R"({"name": "plate", "geometry": "calx.plane", "material": "grain", %
                               "parameters": {"half_u": 0.02, "half_v": 0.02}})";

std::string plate(const std::string& motion) {
  std::string text = kPlate;
  return text.replace(text.find('%'), 1, motion);
}

}  // namespace

TEST_CASE("Columns lie in the engine's own memory and say what they are") {
  Simulation sim = Simulation::from_text(falling_grains(50), with_plugins());
  sim.step(10);
  REQUIRE(sim.particle_count() == 50);
  const auto position = sim.numbers("position");
  const auto velocity = sim.numbers("velocity");
  const auto mass = sim.numbers("mass");
  const auto id = sim.integers("id");
  const auto turn = sim.numbers("orientation");
  std::vector<bool> seen(50, false);
  for (std::size_t k = 0; k < 50; ++k) {
    CHECK(velocity[k][2] == doctest::Approx(-9.81 * sim.time()).epsilon(1e-9));
    CHECK(mass[k][0] == doctest::Approx(2500 * 4 / 3.0 * 3.14159265358979 * std::pow(0.0015, 3)));
    double length = 0;
    for (int c = 0; c < 4; ++c) length += turn[k][c] * turn[k][c];
    CHECK(length == doctest::Approx(1));
    REQUIRE(id[k][0] < 50);
    seen[id[k][0]] = true;
  }
  for (const bool one : seen) CHECK(one);
  CHECK(sim.numbers("position")[0] == position[0]);  // no copy
  CHECK_THROWS_WITH_AS(sim.numbers("velocities"),
                       "calx_sim_particles: no column \"velocities\"; did you mean \"velocity\"?", Failure);
  CHECK_THROWS_AS(sim.numbers("id"), Failure);
}

TEST_CASE("A velocity written is the velocity of the next step; a position written finds its contacts") {
  Simulation sim = Simulation::from_text(falling_grains(2), with_plugins());
  sim.step();
  auto position = sim.numbers("position");
  auto velocity = sim.numbers("velocity");
  for (std::size_t k = 0; k < 2; ++k) velocity[k][0] = k == 0 ? 1.0 : 0.0;
  const double before = position[0][0];
  sim.particles_written();
  sim.step();
  const double moved = sim.numbers("position")[0][0] - before;
  CHECK(moved == doctest::Approx(sim.time_step()).epsilon(1e-9));

  // The second beside the first, overlapping by 0.1 mm: only a list made anew knows of that pair.
  position = sim.numbers("position");
  velocity = sim.numbers("velocity");
  for (int c = 0; c < 3; ++c) {
    position[1][c] = position[0][c] + (c == 1 ? 0.0029 : 0);
    velocity[0][c] = velocity[1][c] = 0;
  }
  sim.particles_written();
  sim.step();
  velocity = sim.numbers("velocity");
  const double apart = velocity[1][1] - velocity[0][1];
  // Hertz: E* = E / (2 (1 - nu^2)), R* = R / 2, F = 4/3 E* sqrt(R*) o^1.5; both grains have the same mass.
  const double force = 4.0 / 3 * 5e6 / (2 * (1 - 0.0625)) * std::sqrt(0.00075) * std::pow(1e-4, 1.5);
  CHECK(apart == doctest::Approx(2 * force / sim.numbers("mass")[0][0] * sim.time_step()).epsilon(1e-6));

  sim.numbers("spin")[1][0] = std::numeric_limits<double>::quiet_NaN();
  try {
    sim.particles_written();
    FAIL("a number that is not finite was taken");
  } catch (const Failure& e) {
    CHECK(e.code() == CALX_SIM_NUMERICS);
  }
}

TEST_CASE("Particles of a case with rest cannot be written") {
  Simulation sim = Simulation::from_text(falling_grains(5, "", R"(, "rest": {})"), with_plugins());
  sim.step();
  try {
    sim.particles_written();
    FAIL("it was taken");
  } catch (const Failure& e) {
    CHECK(e.code() == CALX_SIM_CASE);
    CHECK(std::string(e.what()).find("/rest") != std::string::npos);
  }
}

TEST_CASE("A part driven along the poses of a motion gives the bits of that motion") {
  const std::string motions = R"(, "motions": {"lift": {"plugin": "calx.travel",
      "parameters": {"displacement": [0.002, 0, 0.02], "duration": 0.1}}})";
  Simulation moved = Simulation::from_text(falling_grains(60, plate(R"("motion": "lift",)"), motions), with_plugins());
  Simulation driven = Simulation::from_text(falling_grains(60, plate("")), with_plugins());
  const std::uint32_t part = driven.part("plate");
  for (int k = 0; k < 5000; ++k) {
    driven.drive(part, moved.pose(part));  // at the time of the particles, and of the contacts of the next step
    moved.step();
    driven.step();
  }
  CHECK(driven.digest() == moved.digest());
  // The last pose driven is one step old.
  CHECK(std::abs(driven.pose(part).position[2] - moved.pose(part).position[2]) < 1e-5);
  CHECK(moved.pose(part).position[2] > 0.001);
  const auto a = driven.load(part), b = moved.load(part);
  CHECK(a.force[2] == b.force[2]);
  CHECK(a.force[2] < 0);  // the powder lies on it

  calx_sim_pose bad = moved.pose(part);
  bad.orientation[0] = 2;
  CHECK_THROWS_AS(driven.drive(part, bad), Failure);
  CHECK_THROWS_AS(driven.drive(7, moved.pose(part)), Failure);
  CHECK_THROWS_WITH_AS(driven.part("plat"), "calx_sim_part: the case has none named \"plat\"; did you mean \"plate\"?",
                       Failure);
}

TEST_CASE("The load of a bed at rest on its floor is its weight") {
  Simulation sim = Simulation::from_text(falling_grains(30), with_plugins());
  sim.run_until(0.3);
  double weight = 0;
  const auto mass = sim.numbers("mass");
  for (std::size_t k = 0; k < mass.size(); ++k) weight += 9.81 * mass[k][0];
  // Grains that still rock carry some thousandths of their weight.
  CHECK(sim.load(sim.part("floor")).force[2] == doctest::Approx(-weight).epsilon(0.01));
}

TEST_CASE("Sensors by name, with columns that carry units") {
  const std::string sensors = R"(, "sensors": [{"name": "all", "kind": "bulk-density", "every": 0.1,
      "region": {"box": {"min": [-0.05, -0.05, -0.02], "max": [0.05, 0.05, 0.2]}}},
      {"name": "weight", "kind": "mass", "every": 0.1, "region": {"box": {"min": [-0.05, -0.05, -0.02], "max": [0.05, 0.05, 0.2]}}}])";
  Simulation sim = Simulation::from_text(falling_grains(40, "", sensors), with_plugins());
  sim.step(5);
  CHECK(calx_sim_sensor_count(sim.get()) == 2);
  const std::uint32_t weight = sim.sensor("weight");
  CHECK(std::string(calx_sim_sensor_column(sim.get(), weight, 0)) == "mass_kg");
  CHECK(calx_sim_sensor_column(sim.get(), weight, 99) == nullptr);
  CHECK(sim.sample(weight)[0] == doctest::Approx(40 * sim.numbers("mass")[0][0]));
  double value = 0;
  CHECK(calx_sim_sample(sim.get(), weight, &value, 0) == CALX_SIM_USAGE);
  CHECK(calx_sim_sample(sim.get(), 9, &value, 1) == CALX_SIM_USAGE);
  CHECK_THROWS_AS(sim.sensor("wait"), Failure);
}
