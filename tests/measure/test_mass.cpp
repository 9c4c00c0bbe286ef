#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.01;
constexpr double grain = 4 * FakeWorld::pi / 3 * 1e-3;  // kg, of one sphere of that radius

}  // namespace

TEST_CASE("mass counts particles by their centres and gives their centre of mass") {
  FakeWorld world;
  world.add_box("bed", {0, 0, 0}, {1, 1, 1});
  world.add_sphere({0.2, 0.5, 0.5}, radius);
  world.add_sphere({0.4, 0.5, 0.1}, radius);
  world.add_sphere({1.001, 0.5, 0.5}, radius);
  const auto row = world.sensor(R"({"region": "bed"})", "mass")->sample(world);
  CHECK(row[0] == doctest::Approx(2 * grain));
  CHECK(row[1] == 2);
  CHECK(row[2] == doctest::Approx(0.3));
  CHECK(row[3] == doctest::Approx(0.5));
  CHECK(row[4] == doctest::Approx(0.3));
  CHECK(world.sensor("{}", "mass")->sample(world)[1] == 3);
}

TEST_CASE("mass of an empty region is 0 and has no centre") {
  FakeWorld world;
  world.add_box("bed", {0, 0, 0}, {1, 1, 1});
  const auto row = world.sensor(R"({"region": "bed"})", "mass")->sample(world);
  CHECK(row[0] == 0);
  CHECK(std::isnan(row[2]));
}

TEST_CASE("a region follows its part") {
  FakeWorld world;
  world.add_part("canister");
  world.add_box("inside", {0, 0, 0}, {1, 1, 1}).follows = "canister";
  world.add_sphere({0.5, 0.5, -0.5}, radius);
  const auto sensor = world.sensor(R"({"region": "inside"})", "mass");
  CHECK(sensor->sample(world)[1] == 0);
  world.poses[0].shift = {0, 0, -1};
  CHECK(sensor->sample(world)[1] == 1);
}

TEST_CASE("cycle mass starts with its motion and makes a row due at each completed cycle") {
  FakeWorld world;
  world.add_box("canister", {0, 0, 0}, {1, 1, 1});
  world.add_motion("turn", "valve open");
  for (int k = 0; k < 3; ++k) world.add_sphere({0.5, 0.5, 0.5}, radius);  // there before the start
  const auto sensor = world.sensor(R"({"region": "canister", "motion": "turn", "first": 2})", "cycle-mass");
  REQUIRE(sensor->wants_every_step());
  sensor->step(world);
  world.add_sphere({0.5, 0.5, 0.5}, radius);  // still before the start
  sensor->step(world);
  CHECK(sensor->sample(world)[0] == 0);

  world.events["valve open"] = 1.0;
  sensor->step(world);
  const int gains[] = {5, 3, 4, 2};
  for (int cycle = 0; cycle < 4; ++cycle) {
    for (int k = 0; k < gains[cycle]; ++k) world.add_sphere({0.5, 0.5, 0.5}, radius);
    world.cycles["turn"] = cycle + 0.7;
    sensor->step(world);
    CHECK_FALSE(sensor->row_due());
    world.cycles["turn"] = cycle + 1 - 1e-13;  // a whole cycle but for rounding
    sensor->step(world);
    CHECK(sensor->row_due());
    const auto row = sensor->sample(world);
    CHECK_FALSE(sensor->row_due());
    CHECK(row[0] == cycle + 1);
    CHECK(row[1] == doctest::Approx(gains[cycle] * grain));
  }
  world.add_sphere({0.5, 0.5, 0.5}, radius);  // in the next cycle: the row holds
  const auto row = sensor->sample(world);
  CHECK(row[2] == doctest::Approx(14 * grain));
  CHECK(row[3] == doctest::Approx(3 * grain));  // mean of 3, 4, 2
  CHECK(row[4] == doctest::Approx(1 * grain));  // sd of 3, 4, 2
  CHECK(row[5] == doctest::Approx(3 * grain));  // line through totals 8, 12, 14 at cycles 2, 3, 4
  CHECK(row[6] == doctest::Approx((34.0 / 3 - 9) * grain));
  CHECK(row[7] == doctest::Approx(36.0 / (2 * (56.0 / 3))));
  const auto curves = sensor->curves();
  CHECK(curves[0].y_name == "mass_kg");
  CHECK(curves[0].y[1] == doctest::Approx(3 * grain));
  CHECK(curves[1].x == std::vector<double>{1, 2, 3, 4});
}

TEST_CASE("cycle mass of a motion that a stage starts counts from the end of the stage before") {
  FakeWorld world;
  world.add_box("canister", {0, 0, 0}, {1, 1, 1});
  world.add_motion("turn", "never");
  StageSettings fill, dose;
  fill.name = "fill", fill.until = "settled";
  dose.name = "dose", dose.start = {"turn"};
  world.case_settings.stages = {fill, dose};
  const auto sensor = world.sensor(R"({"region": "canister", "motion": "turn"})", "cycle-mass");
  world.add_sphere({0.5, 0.5, 0.5}, radius);
  sensor->step(world);
  world.add_sphere({0.5, 0.5, 0.5}, radius);
  world.events["settled"] = 0.5;
  sensor->step(world);
  world.add_sphere({0.5, 0.5, 0.5}, radius);
  world.cycles["turn"] = 1;
  CHECK(sensor->sample(world)[1] == doctest::Approx(grain));
}

TEST_CASE("cycle mass goes on after a restart") {
  FakeWorld world;
  world.add_box("canister", {0, 0, 0}, {1, 1, 1});
  world.add_motion("turn", "");
  const char* json = R"({"region": "canister", "motion": "turn"})";
  const auto sensor = world.sensor(json, "cycle-mass");
  sensor->step(world);
  for (int cycle = 1; cycle <= 5; ++cycle) {
    for (int k = 0; k < 3 + cycle % 2; ++k) world.add_sphere({0.5, 0.5, 0.5}, radius);
    world.cycles["turn"] = cycle;
    sensor->step(world);
  }
  FakeState state;
  sensor->save(state, "sensors/probe");
  const auto again = world.sensor(json, "cycle-mass");
  again->load(state, "sensors/probe");
  CHECK(again->row_due());
  world.add_sphere({0.5, 0.5, 0.5}, radius);
  world.cycles["turn"] = 6;
  CHECK(sensor->sample(world) == again->sample(world));
  CHECK(again->curves()[0].y == sensor->curves()[0].y);
}
