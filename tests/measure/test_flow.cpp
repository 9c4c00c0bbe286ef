#include <doctest/doctest.h>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.01;
constexpr double grain = 4 * FakeWorld::pi / 3 * 1e-3;  // kg, of one sphere of that radius

/// A string of spheres 0.05 m apart that starts above z = 0 and falls at 1 m/s: 20 of them per second.
FakeWorld falling_string() {
  FakeWorld world;
  for (int k = 0; k < 40; ++k) world.add_sphere({0, 0, 0.025 + 0.05 * k}, radius);
  return world;
}

void fall(FakeWorld& world, double seconds) {
  for (std::size_t p = 0; p < world.grains.count(); ++p) world.move(p, {0, 0, -seconds});
  world.now += seconds;
  world.steps += 1;
}

}  // namespace

TEST_CASE("a steady stream has its known rate") {
  FakeWorld world = falling_string();
  const auto sensor = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, -3], "radius": 0.1})", "flow");
  CHECK(sensor->sample(world)[1] == 0);
  for (int k = 1; k <= 10; ++k) {
    fall(world, 0.1);
    const auto row = sensor->sample(world);
    CHECK(row[0] == doctest::Approx(2 * k * grain));
    CHECK(row[1] == doctest::Approx(20 * grain));
    CHECK(row[2] == 2 * k);
  }
}

TEST_CASE("against the normal the mass is negative, and each direction can be had alone") {
  FakeWorld world = falling_string();
  const auto net = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, 1]})", "flow");
  const auto forward = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, 1], "direction": "forward"})", "flow");
  const auto backward = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, 1], "direction": "backward"})", "flow");
  for (const auto* sensor : {&net, &forward, &backward}) (*sensor)->sample(world);
  fall(world, 0.5);
  CHECK(net->sample(world)[0] == doctest::Approx(-10 * grain));
  CHECK(forward->sample(world)[0] == 0);
  CHECK(backward->sample(world)[0] == doctest::Approx(-10 * grain));
}

TEST_CASE("a particle that comes back is taken off again") {
  FakeWorld world;
  world.add_sphere({0, 0, 0.1}, radius);
  const auto sensor = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, -1]})", "flow");
  sensor->sample(world);
  world.move(0, {0, 0, -0.2});
  CHECK(sensor->sample(world)[2] == 1);
  world.move(0, {0, 0, 0.2});
  const auto row = sensor->sample(world);
  CHECK(row[0] == 0);
  CHECK(row[2] == 0);
  CHECK(row[3] == doctest::Approx(grain));
  CHECK(row[4] == doctest::Approx(grain));
}

TEST_CASE("only crossings of the disc count") {
  FakeWorld world;
  world.add_sphere({0, 0, 0.1}, radius);
  world.add_sphere({0.3, 0, 0.1}, radius);
  const auto sensor = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, -1], "radius": 0.2})", "flow");
  sensor->sample(world);
  for (std::size_t p : {0, 1}) world.move(p, {p == 0 ? 0.3 : -0.3, 0, -0.2});  // both at 0.15 in the plane
  CHECK(sensor->sample(world)[2] == 2);
  for (std::size_t p : {0, 1}) world.move(p, {0.5, 0, 0.2});  // back at 0.55 and 0.25
  CHECK(sensor->sample(world)[2] == 2);
}

TEST_CASE("sorting anew, new particles and deleted ones cross nothing") {
  FakeWorld world;
  world.add_sphere({0, 0, 0.1}, radius);
  world.add_sphere({0, 0, -0.1}, radius);
  const auto sensor = world.sensor(R"({"point": [0, 0, 0], "normal": [0, 0, -1]})", "flow");
  sensor->sample(world);
  world.swap_ranks(0, 1);
  CHECK(sensor->sample(world)[3] == 0);
  world.add_sphere({0, 0, -0.2}, radius);
  world.erase(0);
  const auto row = sensor->sample(world);
  CHECK(row[3] == 0);
  CHECK(row[4] == 0);
}

TEST_CASE("going through a periodic face crosses only planes on the way") {
  FakeWorld world;
  world.case_settings.domain.box = {{0, 0, 0}, {1, 1, 1}};
  world.case_settings.domain.periodic[2] = true;
  world.add_sphere({0.5, 0.5, 0.05}, radius);
  const auto middle = world.sensor(R"({"point": [0.5, 0.5, 0.5], "normal": [0, 0, -1]})", "flow");
  const auto near = world.sensor(R"({"point": [0.5, 0.5, 0.98], "normal": [0, 0, -1]})", "flow");
  middle->sample(world);
  near->sample(world);
  world.move(0, {0, 0, 0.9});  // 0.1 down and out at the top
  CHECK(middle->sample(world)[2] == 0);
  CHECK(near->sample(world)[2] == 1);
}

TEST_CASE("arrivals in a region are net of those that leave") {
  FakeWorld world;
  world.add_box("tray", {-1, -1, -1}, {1, 1, 0});
  for (int k = 0; k < 3; ++k) world.add_sphere({0, 0, 0.1}, radius);
  const auto sensor = world.sensor(R"({"region": "tray"})", "flow");
  sensor->sample(world);
  world.now = 0.5;
  for (std::size_t p = 0; p < 3; ++p) world.move(p, {0, 0, -0.2});
  world.add_sphere({0, 0, -0.5}, radius);  // made inside: no arrival
  auto row = sensor->sample(world);
  CHECK(row[2] == 3);
  CHECK(row[1] == doctest::Approx(6 * grain));
  world.now = 1;
  world.move(0, {0, 0, 0.2});
  row = sensor->sample(world);
  CHECK(row[0] == doctest::Approx(2 * grain));
  CHECK(row[1] == doctest::Approx(-2 * grain));
}

TEST_CASE("watching every step sees what passes within an interval") {
  FakeWorld world;
  world.add_box("slit", {-1, -1, -0.01}, {1, 1, 0.01});
  world.add_sphere({0, 0, 0.1}, radius);
  const auto slow = world.sensor(R"({"region": "slit"})", "flow");
  const auto fast = world.sensor(R"({"region": "slit", "every_step": true})", "flow");
  CHECK_FALSE(slow->wants_every_step());
  REQUIRE(fast->wants_every_step());
  slow->sample(world);
  fast->sample(world);
  for (int k = 0; k < 20; ++k) {
    world.move(0, {0, 0, -0.01});
    fast->step(world);
  }
  CHECK(slow->sample(world)[3] == 0);
  CHECK(fast->sample(world)[3] == doctest::Approx(grain));
  CHECK(fast->sample(world)[4] == doctest::Approx(grain));
}

TEST_CASE("flow goes on after a restart") {
  FakeWorld world = falling_string();
  const char* json = R"({"point": [0, 0, 0], "normal": [0, 0, -1], "radius": 0.1})";
  const auto sensor = world.sensor(json, "flow");
  sensor->sample(world);
  fall(world, 0.33);
  sensor->sample(world);
  FakeState state;
  sensor->save(state, "sensors/probe");
  const auto again = world.sensor(json, "flow");
  again->load(state, "sensors/probe");
  fall(world, 0.28);
  const auto row = sensor->sample(world);
  CHECK(row[2] == 12);
  CHECK(again->sample(world) == row);
}
