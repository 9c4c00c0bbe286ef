#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.042, grain = 0.0006;  // m
const char* const keys = R"({"region": "drum", "cell": 0.00021})";

FakeWorld drum() {
  FakeWorld world;
  world.add_cylinder("drum", {0, -0.01, 0}, {0, 0.01, 0}, radius);
  return world;
}

/// Grains everywhere below a line through the axis that falls towards +x, so dense that no light comes through.
void fill(FakeWorld& world, double slope, double level, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-radius, radius), depth(-0.01, 0.01);
  for (int k = 0; k < 60000; ++k) {
    const double x = place(random), z = place(random);
    // The upper edge of a disc whose middle is r / cos below the line just touches it.
    const double top = level - slope * x - grain * std::sqrt(1 + slope * slope);
    if (x * x + z * z < radius * radius && z < top) world.add_sphere({x, depth(random), z}, grain);
  }
}

}  // namespace

TEST_CASE("the surface of a filled drum is the line it was filled to") {
  for (double angle : {0.0, 25.0, 40.0, -30.0}) {
    FakeWorld world = drum();
    fill(world, std::tan(angle * FakeWorld::pi / 180), -0.002, 3);
    const auto sensor = world.sensor(keys, "drum-surface");
    const auto row = sensor->sample(world);
    INFO("angle ", angle, " found ", row[0], " far ", row[1], " level ", row[4], " rms ", row[2]);
    // One frame: the edge of random discs is rough by a part of their radius; a cell is 0.21 mm.
    CHECK(std::abs(row[0] - angle) < 0.5);
    CHECK(std::abs(row[1] - angle) < 0.5);
    CHECK(std::abs(row[4] + 0.002) < 0.0003);
    CHECK(row[2] < 0.0002);
    CHECK(row[6] == 1);
    const CurveResult curve = sensor->curves().at(0);
    CHECK(curve.x_name == "u_m");
    CHECK(curve.x.size() > 200);
  }
}

TEST_CASE("the dark share is that of the circle below the surface") {
  FakeWorld world = drum();
  fill(world, 0, 0, 5);
  // Half of the circle; random discs leave the outermost ring and a few cells light.
  CHECK(world.sensor(keys, "drum-surface")->sample(world)[5] == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("the surface is where the bed is found in half of the frames, also after a restart") {
  FakeWorld low = drum(), high = drum();
  fill(low, 0, -0.004, 1);
  fill(high, 0, 0.004, 2);
  const auto sensor = low.sensor(keys, "drum-surface");
  // Two frames at +4 mm, three at -4 mm: the lower one has the majority.
  sensor->sample(low);
  sensor->sample(high);
  sensor->sample(low);
  FakeState state;
  sensor->save(state, "s");
  const auto resumed = low.sensor(keys, "drum-surface");
  resumed->load(state, "s");
  for (const auto* each : {&sensor, &resumed}) {
    (*each)->sample(high);
    const auto row = (*each)->sample(low);
    CHECK(std::abs(row[4] + 0.004) < 0.0003);
    CHECK(row[6] == 5);
  }
}

TEST_CASE("frames before the start event do not count") {
  FakeWorld world = drum();
  fill(world, 0.5, 0, 4);
  world.case_settings.events.push_back({"steady", {}});
  const auto sensor = world.sensor(R"({"region": "drum", "start": "steady"})", "drum-surface");
  CHECK(sensor->sample(world)[6] == 0);
  CHECK(std::isnan(sensor->sample(world)[0]));
  world.events["steady"] = 1.5;
  CHECK(sensor->sample(world)[6] == 1);
}

TEST_CASE("a drum is a lying cylinder, and events are known by name") {
  FakeWorld world = drum();
  world.add_box("box", {0, 0, 0}, {1, 1, 1});
  world.add_cylinder("upright", {0, 0, 0}, {0, 0, 1}, 0.1);
  CHECK(world.error_of(R"({"region": "box"})", "drum-surface") ==
        "case.json /sensors/0/region: region \"box\" is no cylinder; the inside of the drum is needed");
  CHECK(world.error_of(R"({"region": "upright"})", "drum-surface") ==
        "case.json /sensors/0/region: the axis of region \"upright\" is not horizontal");
  world.case_settings.events.push_back({"steady", {}});
  CHECK(world.error_of(R"({"region": "drum", "start": "stedy"})", "drum-surface") ==
        "case.json /sensors/0/start: unknown event \"stedy\"; did you mean \"steady\"?");
}
