// Stages and events: parts come and go, motions start, runs end.
#include <doctest/doctest.h>

#include <cmath>

#include "support/case.hpp"

using namespace calx;

namespace {

CaseText shelves() {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.parts = R"([
    {"name": "shelf", "geometry": "calx.plane", "material": "sand", "parameters": {"half_u": 0.1, "half_v": 0.1}},
    {"name": "floor", "geometry": "calx.plane", "material": "sand", "present": false,
     "parameters": {"point": [0, 0, -0.01], "half_u": 0.1, "half_v": 0.1}},
    {"name": "lift", "geometry": "calx.plane", "material": "sand", "motion": "up", "present": false,
     "parameters": {"point": [0, 0, -0.02], "half_u": 0.1, "half_v": 0.1}}])";
  c.more =
      R"("motions": {"up": {"plugin": "calx.travel", "parameters": {"displacement": [0, 0, 0.015], "duration": 0.05, "profile": "cosine"}}},
    "stages": [{"name": "hold", "until": {"time": 0.01}},
               {"name": "drop", "until": {"time": 0.16}, "remove": ["shelf"], "add": ["floor"]},
               {"name": "lift", "remove": ["floor"], "add": ["lift"], "start": ["up"]}])";
  return c;
}

}  // namespace

TEST_CASE("stages remove and add parts and start motions") {
  for (const char* shape : {"ball", "grain"}) {
    Simulation sim(
        with_given(shelves(), shape, {{{0, 0, 0.000999}, {}, {}, {0.7071067811865476, 0.7071067811865476, 0, 0}}}),
        test_options());
    while (sim.time() < 0.0095) sim.step();
    CHECK(body_of(sim, 0).z == doctest::Approx(0.001).scale(0).epsilon(0.1));
    CHECK(sim.world().part_present(0));
    CHECK_FALSE(sim.world().part_present(1));
    while (sim.time() < 0.155) sim.step();
    CHECK_FALSE(sim.world().part_present(0));
    CHECK(sim.world().part_present(1));
    CHECK(body_of(sim, 0).z == doctest::Approx(-0.009).scale(0).epsilon(0.02));
    CHECK(norm(sim.world().part_load(0).force) == 0);
    CHECK(sim.world().part_load(1).force.z < 0);
    // The floor goes, the lift takes the particle up to -5 mm, lying or on end.
    while (sim.time() < 0.45) sim.step();
    CHECK(body_of(sim, 0).z == doctest::Approx(-0.00385).scale(0).epsilon(0.05));
    CHECK(sim.world().event_time("stage hold") == doctest::Approx(0.01).epsilon(1e-3));
    CHECK(sim.world().event_time("stage lift begins") == doctest::Approx(0.16).epsilon(1e-3));
    std::string said;
    for (const auto& m : sim.take_messages()) said += m + "\n";
    CHECK(said.find("t = 0.0100 s: stage \"drop\"") != std::string::npos);
    CHECK(said.find("part \"shelf\" is removed") != std::string::npos);
    CHECK(said.find("part \"lift\" appears") != std::string::npos);
  }
}

TEST_CASE("a part appears and vanishes at events") {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.parts =
      R"([{"name": "late", "geometry": "calx.plane", "material": "sand", "appears": {"time": 0.02}, "vanishes": {"time": 0.06},
                 "parameters": {"point": [0, 0, -0.01], "half_u": 0.1, "half_v": 0.1}}])";
  Simulation sim(with_given(c, "ball", {{{0, 0, 0}, {}, {}, {}}}), test_options());
  while (sim.time() < 0.0195) sim.step();
  CHECK_FALSE(sim.world().part_present(0));
  while (sim.time() < 0.058) sim.step();
  CHECK(sim.world().part_present(0));
  CHECK(body_of(sim, 0).z > -0.0095);
  while (sim.time() < 0.12) sim.step();
  CHECK_FALSE(sim.world().part_present(0));
  CHECK(body_of(sim, 0).z < -0.015);
}

TEST_CASE("a run ends at its end time or at its end event") {
  CaseText c;
  c.time = R"({"step": 1e-5, "end": 0.001})";
  Simulation sim(with_given(c, "ball", {{{}, {}, {}, {}}}), test_options());
  while (!sim.finished()) sim.step();
  CHECK(sim.step_count() == 100);
  c.time = R"({"step": 1e-5, "end": 1, "end_event": {"count": {"region": "far", "at_least": 1}}})";
  c.more = R"("regions": {"far": {"box": {"min": [0.01, -1, -1], "max": [1, 1, 1]}}})";
  Simulation other(with_given(c, "ball", {{{}, {2, 0, 0}, {}, {}}}), test_options());
  while (!other.finished()) other.step();
  // 0.01 m at 2 m/s; asked every 2 ms.
  CHECK(other.time() >= 0.005);
  CHECK(other.time() < 0.0071);
}

TEST_CASE("a part stands where its motion has it at the time of the particles") {
  for (const char* integrator : {"euler", "verlet"}) {
    CaseText c;
    c.time = R"({"step": 1e-5, "end": 0.1, "integrator": ")" + std::string(integrator) + R"("})";
    c.parts = R"([{"name": "lift", "geometry": "calx.plane", "material": "sand", "motion": "up",
                   "parameters": {"point": [0, 0, -0.02], "half_u": 0.1, "half_v": 0.1}}])";
    c.more =
        R"("motions": {"up": {"plugin": "calx.travel", "start": {"time": 0.0102},
                          "parameters": {"displacement": [0, 0, 0.02], "speed": 0.5}}})";
    Simulation sim(with_given(c, "ball", {{{}, {}, {}, {}}}), test_options());
    CHECK(sim.world().part_pose(0).shift.z == 0);
    while (sim.time() < 0.03) sim.step();
    CHECK(std::abs(sim.world().part_pose(0).shift.z - 0.5 * (sim.time() - 0.0102)) < 1e-12);
    CHECK(sim.world().part_pose(0).velocity.z == 0.5);
  }
}
