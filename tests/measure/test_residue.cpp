#include <doctest/doctest.h>

#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.01;
constexpr double grain = 4 * FakeWorld::pi / 3 * 1e-3;  // kg, of one sphere of that radius

}  // namespace

TEST_CASE("what a part carries is found through chains of contacts") {
  FakeWorld world;
  world.add_part("port");
  world.add_part("nozzle");
  for (int k = 0; k < 6; ++k) world.add_sphere({0, 0, 0.02 * k}, radius);
  world.touch_part(0, 0, {0, 0, 1});     // 0 lies on the port
  world.touch(1, 0, {0.6, 0, 0.8});      // 1 on 0
  world.touch(1, 2, {0, 0, -1});         // 2 on 1, listed the other way round
  world.touch_part(3, 1, {0, 0, 1});     // 3 lies on the nozzle
  world.touch_part(4, 0, {0, 0, -1});    // 4 hangs below the port
  world.touch_part(5, 0, {1, 0, 0.05});  // 5 leans on its steep side
  const auto sensor = world.sensor(R"({"part": "port"})", "residue");
  auto row = sensor->sample(world);
  CHECK(row[1] == 3);
  CHECK(row[0] == doctest::Approx(3 * grain));
  world.present[0] = false;
  CHECK(sensor->sample(world)[1] == 0);
}

TEST_CASE("what lies beside, or under, does not count as lying on it") {
  FakeWorld world;
  world.add_part("port");
  for (int k = 0; k < 3; ++k) world.add_sphere({0.02 * k, 0, 0}, radius);
  world.touch_part(0, 0, {0, 0, 1});
  world.touch(1, 0, {1, 0, 0});       // beside
  world.touch(2, 0, {0.6, 0, -0.8});  // under
  CHECK(world.sensor(R"({"part": "port"})", "residue")->sample(world)[1] == 1);
}

TEST_CASE("up is against gravity") {
  FakeWorld world;
  world.case_settings.gravity = {9.81, 0, 0};
  world.add_part("port");
  world.add_sphere({0, 0, 0}, radius);
  world.add_sphere({0, 0, 1}, radius);
  world.touch_part(0, 0, {-1, 0, 0});
  world.touch_part(1, 0, {0, 0, 1});
  CHECK(world.sensor(R"({"part": "port"})", "residue")->sample(world)[1] == 1);
}

TEST_CASE("fast particles are not residue; speed is taken against the moving part") {
  FakeWorld world;
  world.add_part("port");
  world.add_box("collar", {-1, -1, 0}, {1, 1, 1}).follows = "port";
  world.poses[0].velocity = {0, 0, -0.03};
  world.add_sphere({0, 0, 0.1}, radius, {0, 0, -0.03});
  world.add_sphere({0, 0, 0.2}, radius, {0, 0, 0});
  world.add_sphere({0, 0, -0.2}, radius, {0, 0, -0.03});  // not in the region
  CHECK(world.sensor(R"({"region": "collar"})", "residue")->sample(world)[1] == 1);
  CHECK(world.sensor(R"({"region": "collar", "speed": {"value": 50, "unit": "mm/s"}})", "residue")->sample(world)[1] ==
        2);
}

TEST_CASE("part and region together count what fulfils both") {
  FakeWorld world;
  world.add_part("port");
  world.add_box("collar", {-1, -1, 0}, {1, 1, 1});
  world.add_sphere({0, 0, 0.1}, radius);
  world.add_sphere({2, 0, 0.1}, radius);
  world.add_sphere({0, 0, 0.5}, radius);
  world.touch_part(0, 0, {0, 0, 1});
  world.touch_part(1, 0, {0, 0, 1});
  CHECK(world.sensor(R"({"region": "collar", "part": "port"})", "residue")->sample(world)[1] == 1);
}

TEST_CASE("a clump rests with any of its spheres") {
  FakeWorld world;
  world.add_part("port");
  world.add_dumbbell({0, 0, 0.02}, radius);
  world.add_dumbbell({0.03, 0, 0.03}, radius);
  world.touch_part(0, 0, {0, 0, 1});
  world.touch(2, 1, {0.8, 0, 0.6});
  CHECK(world.sensor(R"({"part": "port"})", "residue")->sample(world)[1] == 2);
}
