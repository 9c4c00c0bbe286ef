#include <doctest/doctest.h>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

FakeWorld loaded_rotor() {
  FakeWorld world;
  world.add_part("housing");
  world.add_part("rotor");
  world.loads[1] = {{1, 2, 3}, {0, -0.5, 0.25}};
  world.poses[1].velocity = {0.1, 0, -1};
  world.poses[1].spin = {0, 10, 2};
  return world;
}

}  // namespace

TEST_CASE("load and power of the part named") {
  const FakeWorld world = loaded_rotor();
  const auto sensor = world.sensor(R"({"part": "rotor"})", "part-load");
  CHECK(sensor->columns().back() == "power_W");
  CHECK(sensor->columns()[4] == "torque_y_N_m");
  const auto row = sensor->sample(world);
  CHECK(std::vector<double>(row.begin(), row.begin() + 6) == std::vector<double>{1, 2, 3, 0, -0.5, 0.25});
  CHECK(row[6] == doctest::Approx(0.1 - 3 - 5 + 0.5));
}

TEST_CASE("a part that is not in the world has no load") {
  FakeWorld world = loaded_rotor();
  world.present[1] = false;
  CHECK(world.sensor(R"({"part": "rotor"})", "part-load")->sample(world) == std::vector<double>(7, 0));
}

TEST_CASE("with every_step a row holds the mean since the row before, also across a restart") {
  FakeWorld world = loaded_rotor();
  const char* json = R"({"part": "rotor", "every_step": true})";
  auto sensor = world.sensor(json, "part-load");
  REQUIRE(sensor->wants_every_step());
  for (double fx : {1.0, 5.0}) {
    world.loads[1].force.x = fx;
    sensor->step(world);
  }
  FakeState state;
  sensor->save(state, "s");
  sensor = world.sensor(json, "part-load");
  sensor->load(state, "s");
  world.loads[1].force.x = 0;
  sensor->step(world);
  CHECK(sensor->sample(world)[0] == 2);
  world.loads[1].force.x = 7;
  sensor->step(world);
  CHECK(sensor->sample(world)[0] == 7);
}
