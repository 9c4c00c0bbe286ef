#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_world.hpp"

using namespace calx;

namespace {

/// n^3 spheres of radius 0.5 touching in a simple cubic lattice, corner at the origin.
void add_lattice(FakeWorld& world, int n) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) world.add_sphere({i + 0.5, j + 0.5, k + 0.5}, 0.5);
}

}  // namespace

TEST_CASE("a simple cubic lattice has solid fraction pi / 6, wherever the box of whole cells cuts it") {
  FakeWorld world;
  add_lattice(world, 6);
  for (double shift : {1.0, 1.27, 1.5}) {
    world.case_settings.regions.clear();
    world.add_box("bed", {shift, shift, shift}, {shift + 3, shift + 3, shift + 3});
    const auto row = world.sensor(R"({"region": "bed"})", "bulk-density")->sample(world);
    CHECK(row[1] == doctest::Approx(FakeWorld::pi / 6).epsilon(1e-8));
    CHECK(row[0] == doctest::Approx(1000 * FakeWorld::pi / 6).epsilon(1e-8));
    CHECK(row[2] == doctest::Approx(27 * 1000 * FakeWorld::pi / 6).epsilon(1e-8));
  }
}

TEST_CASE("a face-centred cubic lattice has solid fraction pi / sqrt(18)") {
  FakeWorld world;
  const double a = 1, r = a / std::sqrt(8.0);
  for (int i = -1; i < 7; ++i)
    for (int j = -1; j < 7; ++j)
      for (int k = -1; k < 7; ++k)
        if ((i + j + k) % 2 == 0) world.add_sphere({i * a / 2, j * a / 2, k * a / 2}, r);
  world.add_box("bed", {0, 0, 0}, {2 * a, 2 * a, 2 * a});
  const auto row = world.sensor(R"({"region": "bed"})", "bulk-density")->sample(world);
  CHECK(row[1] == doctest::Approx(FakeWorld::pi / std::sqrt(18.0)).epsilon(1e-8));
}

TEST_CASE("a cylinder across a lattice comes close to the bulk value and follows a turned part") {
  FakeWorld world;
  add_lattice(world, 10);
  world.add_part("cell");
  world.add_cylinder("core", {5, 5, 1}, {5, 5, 9}, 3.99).follows = "cell";
  const auto sensor = world.sensor(R"({"region": "core"})", "bulk-density");
  const double upright = sensor->sample(world)[1];
  CHECK(upright == doctest::Approx(FakeWorld::pi / 6).epsilon(0.02));
  // A quarter turn about x through the lattice's centre: the lattice looks the same.
  const double half = std::sqrt(0.5);
  world.poses[0].turn = {half, half, 0, 0};
  world.poses[0].shift = Vec3{5, 5, 5} - rotate(world.poses[0].turn, {5, 5, 5});
  CHECK(sensor->sample(world)[1] == doctest::Approx(upright).epsilon(1e-9));
}

TEST_CASE("clumps share their volume over their members") {
  FakeWorld world;
  world.add_box("lower half", {-2, -2, -2}, {2, 2, 0});
  world.add_dumbbell({0, 0, 0}, 0.5);
  // Members that overlap: the clump's volume is less than the sum of its spheres'.
  world.grains.shapes[0].volume = 2 * FakeWorld::pi;
  world.grains.body[0].m = 1000 * 2 * FakeWorld::pi / 8;
  const auto row = world.sensor(R"({"region": "lower half"})", "bulk-density")->sample(world);
  CHECK(row[1] == doctest::Approx(0.5 * 2 * FakeWorld::pi / 8 / 32));
  CHECK(row[2] == doctest::Approx(0.5 * world.grains.body[0].m));
}

TEST_CASE("images across a periodic face count") {
  FakeWorld world;
  world.case_settings.domain.box = {{0, 0, 0}, {2, 2, 2}};
  world.add_box("all", {0, 0, 0}, {2, 2, 2});
  world.add_sphere({0.1, 1.9, 1}, 0.5);
  const auto sensor = world.sensor(R"({"region": "all"})", "bulk-density");
  const double cut = sensor->sample(world)[1];
  world.case_settings.domain.periodic = {true, true, false};
  CHECK(sensor->sample(world)[1] == doctest::Approx(FakeWorld::pi / 6 / 8).epsilon(1e-9));
  CHECK(cut < 0.6 * FakeWorld::pi / 6 / 8);
}
