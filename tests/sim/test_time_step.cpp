// Limits of the time step: what they are, which one binds, and what is refused.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.hpp"
#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

constexpr double kPi = 3.14159265358979323846;

CaseText dropped() {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.time = R"({"end": 1})";
  c.sources = R"([{"name": "fill", "shape": "ball", "material": "sand", "count": 10,
                   "region": {"box": {"min": [0, 0, 0.2], "max": [0.1, 0.1, 0.3]}}}])";
  c.parts =
      R"([{"name": "floor", "geometry": "calx.plane", "material": "sand", "parameters": {"point": [0, 0, -0.2]}}])";
  return c;
}

const StepLimit& limit(const std::vector<StepLimit>& all, const std::string& name) {
  for (const auto& l : all)
    if (l.name == name) return l;
  FAIL("no limit " << name);
  return all.front();
}

}  // namespace

TEST_CASE("Hertz-Mindlin: Rayleigh, collision and law limits are listed, and the smallest binds") {
  Simulation sim(dropped().file(), test_options());
  const auto all = sim.step_limits();
  const double shear = 1e7 / 2.5, rayleigh = kPi * 1e-3 * std::sqrt(2000 / shear) / (0.1631 * 0.25 + 0.8766);
  CHECK(limit(all, "rayleigh").seconds == near(0.1 * rayleigh, 1e-12));
  CHECK(limit(all, "rayleigh").where.find("sand") != std::string::npos);
  // Fall from the top of the source to the floor: 0.5 m.
  const double v = std::sqrt(2 * 9.81 * 0.5), m = 2000 * 4.0 / 3 * kPi * 1e-9 / 2, r = 5e-4,
               e = 1e7 / (2 * (1 - 0.0625));
  CHECK(limit(all, "hertz").seconds == near(2.87 * std::pow(m * m / (r * e * e * v), 0.2) / 20, 1e-9));
  // 0.17 sqrt(m* / S_n) at the overlap of an elastic impact.
  const double k = 4.0 / 3 * e * std::sqrt(r), overlap = std::pow(5 * m * v * v / (4 * k), 0.4);
  CHECK(limit(all, "law").seconds == near(0.17 * std::sqrt(m / (2 * e * std::sqrt(r * overlap))), 1e-6));
  CHECK(limit(all, "law").where.find("sand-sand") != std::string::npos);
  int binding = 0;
  for (const auto& l : all) {
    binding += l.binds;
    CHECK(l.seconds >= sim.time_step());
    if (l.binds) CHECK(l.seconds == sim.time_step());
  }
  CHECK(binding == 1);
}

TEST_CASE("the smallest sphere of the smallest particle sets the Rayleigh limit") {
  CaseText c = dropped();
  c.sources =
      R"([{"name": "a", "shape": "odd", "material": "sand", "count": 2, "region": {"box": {"min": [0, 0, 0.2], "max": [0.1, 0.1, 0.3]}},
                   "size": {"distribution": "list", "scales": [1, 0.5, 2], "shares": [1, 1, 1]}}])";
  Simulation sim(c.file(), test_options());
  const double shear = 1e7 / 2.5;
  CHECK(limit(sim.step_limits(), "rayleigh").seconds ==
        near(0.1 * kPi * 0.3e-3 * std::sqrt(2000 / shear) / (0.1631 * 0.25 + 0.8766), 1e-12));
}

TEST_CASE("a fast part limits the step, and is named") {
  CaseText c = dropped();
  c.parts =
      R"([{"name": "shaker", "geometry": "calx.plane", "material": "sand", "motion": "m", "parameters": {"point": [0, 0, -0.2]}}])";
  c.more = R"("motions": {"m": {"plugin": "calx.vibration", "parameters": {"amplitude": 0.01, "frequency": 500}}})";
  Simulation sim(c.file(), test_options());
  const auto all = sim.step_limits();
  const StepLimit& wall = limit(all, "wall");
  CHECK(wall.seconds == near(0.02 * 1e-3 / (0.01 * 2 * kPi * 500), 1e-9));
  CHECK(wall.binds);
  CHECK(wall.where.find("\"shaker\"") != std::string::npos);
  CHECK(sim.time_step() == wall.seconds);
}

TEST_CASE("a step of the case's own is taken, up to what is stable") {
  CaseText c = dropped();
  c.time = R"({"step": 3e-6, "end": 1})";
  CHECK(Simulation(c.file(), test_options()).time_step() == 3e-6);
  c.time = R"({"step": 1e-3, "end": 1})";
  CHECK_THROWS_WITH_AS(Simulation(c.file(), test_options()),
                       doctest::Contains("test.json /time/step: 0.001 s is above the limit of"), Error);
  CHECK_THROWS_WITH_AS(Simulation(c.file(), test_options()), doctest::Contains("or leave \"step\" out"), Error);
}

TEST_CASE("each limit says above what a given step is refused") {
  CaseText c = dropped();
  c.time = R"({"rayleigh_fraction": 0.2, "end": 1})";
  const auto all = Simulation(c.file(), test_options()).step_limits();
  CHECK(limit(all, "rayleigh").refused_above == near(2.5 * limit(all, "rayleigh").seconds, 1e-12));
  CHECK(limit(all, "hertz").refused_above == near(4 * limit(all, "hertz").seconds, 1e-12));
  CHECK(limit(all, "law").refused_above == near(3 * limit(all, "law").seconds, 1e-12));
}

TEST_CASE("the law's limit at the largest overlap of the run is told") {
  CaseText c;
  c.time = R"({"step": 1e-6, "end": 1})";
  // Two balls of 1 mm overlap by 0.04 mm at the start; they part, so that this stays the largest overlap.
  Simulation sim(with_given(c, "ball", {{{0, 0, 0}, {}, {}, {}}, {{0.00196, 0, 0}, {}, {}, {}}}), test_options());
  CHECK(sim.law_limit_seen().seconds == 0);
  advance(sim, 20);
  const double m = 2000 * 4.0 / 3 * kPi * 1e-9 / 2, r = 5e-4, e = 1e7 / (2 * (1 - 0.0625));
  CHECK(sim.law_limit_seen().seconds == near(0.17 * std::sqrt(m / (2 * e * std::sqrt(r * 4e-5))), 1e-6));
  CHECK(sim.law_limit_seen().where == "sand-sand at an overlap of 4e-05 m");
}

TEST_CASE("moduli give the Rayleigh limit also where the law does not read them") {
  CaseText c = dropped();
  c.contacts =
      R"([{"between": ["sand", "sand"], "law": "calx.linear", "parameters": {"kn": 1000, "restitution": 0.5, "friction": 0.3}}])";
  Simulation sim(c.file(), test_options());
  CHECK(limit(sim.step_limits(), "rayleigh").seconds > 0);
  CHECK(limit(sim.step_limits(), "law").seconds ==
        near(0.17 * std::sqrt(2000 * 4.0 / 3 * kPi * 1e-9 / 2 / 1000), 1e-9));
}

TEST_CASE("without any limit the case must give a step") {
  CaseText c = dropped();
  c.sources = "[]";
  CHECK_THROWS_WITH_AS(
      Simulation(c.file(), test_options()),
      doctest::Contains("no limit is known for the time step: no source says which particles come; give \"step\" in s"),
      Error);
}

TEST_CASE("a spelling mistake in a material is told") {
  CaseText c = dropped();
  c.materials = R"({"sand": {"density": 2000, "yuong": 1e7, "poisson": 0.25}})";
  CHECK_THROWS_WITH_AS(Simulation(c.file(), test_options()), doctest::Contains("young"), Error);
}
