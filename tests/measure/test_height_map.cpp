#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_world.hpp"
#include "measure/height_map.hpp"

using namespace calx;

TEST_CASE("a cell holds the highest sphere point over its square") {
  HeightMap map({0, 0, 0}, {1, 1, 0}, 0.25);
  REQUIRE(map.nx() == 4);
  Record sphere{};
  sphere.x = 0.375, sphere.y = 0.375, sphere.z = 1, sphere.r = 0.2;
  map.add(sphere);
  CHECK(map.at(1, 1) == doctest::Approx(1.2));                                  // below the centre
  CHECK(map.at(2, 1) == doctest::Approx(1 + std::sqrt(0.04 - 0.125 * 0.125)));  // nearest edge 0.125 away
  CHECK(map.at(2, 2) == doctest::Approx(1 + std::sqrt(0.04 - 2 * 0.125 * 0.125)));
  CHECK(std::isnan(map.at(3, 1)));
  sphere.z = 0.5;
  map.add(sphere);
  CHECK(map.at(1, 1) == doctest::Approx(1.2));
}

TEST_CASE("a tilted layer of spheres has its slope, range, section and field") {
  FakeWorld world;
  world.add_box("bed", {0, 0, -1}, {1, 0.5, 2});
  const double slope = std::tan(20 * FakeWorld::pi / 180);
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 25; ++j) {
      const double x = 0.01 + 0.02 * i;
      world.add_sphere({x, 0.01 + 0.02 * j, slope * x}, 0.01);
    }
  const auto sensor = world.sensor(R"({"region": "bed", "cell": 0.02})", "height-map");
  const auto row = sensor->sample(world);
  CHECK(row[0] == doctest::Approx(slope * 0.5 + 0.01).epsilon(1e-3));
  CHECK(row[1] == doctest::Approx(slope * 0.01 + 0.01));
  CHECK(row[2] == doctest::Approx(slope * 0.99 + 0.01));
  CHECK(row[3] == 1);
  CHECK(row[4] == doctest::Approx(20).epsilon(1e-3));
  CHECK(row[5] == doctest::Approx(0.5));
  CHECK(row[6] == doctest::Approx(0.25));
  const FieldResult field = sensor->fields().at(0);
  CHECK(field.nx == 50);
  CHECK(field.ny == 25);
  CHECK(field.unit == "m");
  const CurveResult section = sensor->curves().at(0);
  REQUIRE(section.x.size() == 50);
  CHECK(section.x[10] == doctest::Approx(0.21));
  CHECK(section.y[10] == doctest::Approx(slope * 0.21 + 0.01));
}

TEST_CASE("the azimuthal mean of a tilted layer is level, that of a cone falls") {
  FakeWorld world;
  world.add_box("bed", {-1, -1, -1}, {1, 1, 2});
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) {
      const double x = 0.04 * i, y = 0.04 * j;
      world.add_sphere({x, y, 1 - 0.5 * std::sqrt(x * x + y * y)}, 0.02);
    }
  const auto sensor = world.sensor(R"({"region": "bed", "cell": 0.08})", "height-map");
  sensor->sample(world);
  const CurveResult ring = sensor->curves().at(1);
  // Rings one cell wide; a cell's highest point lies up to a cell's diagonal towards the apex, which lifts all alike.
  const double slope = (ring.y[8] - ring.y[2]) / (ring.x[8] - ring.x[2]);
  CHECK(slope == doctest::Approx(-0.5).epsilon(0.05));
}

TEST_CASE("empty cells are NaN and an empty bed has no heights") {
  FakeWorld world;
  world.add_box("bed", {0, 0, 0}, {1, 1, 1});
  const auto sensor = world.sensor(R"({"region": "bed", "cell": 0.5})", "height-map");
  const auto empty = sensor->sample(world);
  CHECK(std::isnan(empty[0]));
  CHECK(empty[3] == 0);
  world.add_sphere({0.25, 0.25, 0.5}, 0.1);
  CHECK(sensor->sample(world)[3] == 0.25);
  const std::vector<double> values = sensor->fields().at(0).values;
  CHECK(values[0] == doctest::Approx(0.6));
  CHECK(std::isnan(values[1]));
  CHECK(std::isnan(values[2]));
}

TEST_CASE("the map moves with the part its region follows") {
  FakeWorld world;
  world.add_part("canister");
  world.add_box("bed", {0, 0, 0}, {1, 1, 1}).follows = "canister";
  world.poses[0].shift = {0, 0, -3};
  world.poses[0].shift.x = 2;
  world.add_sphere({2.25, 0.25, -2.5}, 0.1);
  const auto sensor = world.sensor(R"({"region": "bed", "cell": 0.5})", "height-map");
  CHECK(sensor->sample(world)[2] == doctest::Approx(-2.4));
  CHECK(sensor->fields().at(0).origin.x == doctest::Approx(2));
  CHECK(sensor->fields().at(0).values[0] == doctest::Approx(-2.4));
}
