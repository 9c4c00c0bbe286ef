#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_world.hpp"

using namespace calx;

TEST_CASE("a chain on a floor: partners, rattlers and overlaps") {
  FakeWorld world;
  world.add_part("floor");
  for (int k = 0; k < 4; ++k) world.add_sphere({0, 0, 1.0 * k}, k == 0 ? 0.5 : 0.25);
  world.add_sphere({5, 0, 0}, 0.5);  // alone
  world.touch_part(0, 0, {0, 0, 1}, 0.01);
  world.touch(1, 0, {0, 0, 1}, 0.02);
  world.touch(2, 1, {0, 0, 1}, 0.005);
  world.touch(3, 2, {0, 0, 1}, 0.001);
  const auto row = world.sensor("{}", "coordination")->sample(world);
  CHECK(row[0] == doctest::Approx(7.0 / 5));  // 2, 2, 2, 1, 0
  CHECK(row[1] == doctest::Approx(2));        // the first three
  CHECK(row[2] == doctest::Approx(2.0 / 5));
  CHECK(row[3] == doctest::Approx(7.0 / 5));
  CHECK(row[4] == doctest::Approx((0.02 + 0.08 + 0.02 + 0.004) / 4));
  CHECK(row[5] == doctest::Approx(0.08));  // 0.02 over the smaller radius
  CHECK(world.sensor(R"({"rattler_partners": 0})", "coordination")->sample(world)[1] == doctest::Approx(7.0 / 4));
}

TEST_CASE("a region takes contacts of its particles only, once per particle inside") {
  FakeWorld world;
  world.add_box("lower", {-1, -1, -1}, {1, 1, 0.5});
  for (int k = 0; k < 3; ++k) world.add_sphere({0, 0, 1.0 * k}, 0.5);
  world.touch(1, 0, {0, 0, 1}, 0.01);
  world.touch(2, 1, {0, 0, 1}, 0.05);
  const auto row = world.sensor(R"({"region": "lower"})", "coordination")->sample(world);
  CHECK(row[0] == 1);
  CHECK(row[3] == 1);
  CHECK(row[5] == doctest::Approx(0.02));
}

TEST_CASE("two clumps that touch at two places are one partner and two contacts") {
  FakeWorld world;
  world.add_dumbbell({0, 0, 0}, 0.5);
  world.add_dumbbell({1, 0, 0}, 0.5);
  world.touch(0, 2, {-1, 0, 0});
  world.touch(1, 3, {-1, 0, 0});
  const auto row = world.sensor("{}", "coordination")->sample(world);
  CHECK(row[0] == 1);
  CHECK(row[3] == 2);
}

TEST_CASE("nothing there gives NaN, not 0") {
  const FakeWorld world;
  for (double value : world.sensor("{}", "coordination")->sample(world)) CHECK(std::isnan(value));
}
