#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

const char* const json = R"({"parts": ["coupon"], "area": 0.5, "motion": "lid", "slider": "coupon", "shear": [-1, 0, 0],
                             "window": 0.01, "steady": 0.02, "first": 2})";

FakeWorld coupon() {
  FakeWorld world;
  world.dt = 1e-3;
  world.add_part("coupon");
  world.add_motion("lid", "");
  world.poses[0].velocity = {0.01, 0, 0};
  world.add_sphere({0, 0, 0}, 0.1);
  return world;
}
/// A step of the lid: 40 time steps at a normal stress, Pa, and a shear stress that grows by `rise` of it per window.
void run_step(FakeWorld& world, Sensor& sensor, double number, double normal, double shear, double rise) {
  for (int k = 0; k < 40; ++k) {
    const double now = shear * (1 + rise * (k / 10 - 3));
    world.loads[0].force = {-0.5 * now, 0, -0.5 * normal};
    world.cycles["lid"] = k == 39 ? number - 1e-12 : number - 0.5;  // rounded
    sensor.step(world);
  }
}

}  // namespace

TEST_CASE("a point for each load, a line through the steady ones, rows only when a step ends") {
  FakeWorld world = coupon();
  auto sensor = world.sensor(json, "wall-friction");
  run_step(world, *sensor, 1, 9000, 9000, 0);
  CHECK_FALSE(sensor->row_due());  // run in
  CHECK(sensor->sample(world)[0] == 0);
  // shear = 100 + 0.4 normal; the third one is not steady and wrong.
  run_step(world, *sensor, 2, 8000, 3300, 0.01);
  CHECK(sensor->row_due());
  auto row = sensor->sample(world);
  CHECK_FALSE(sensor->row_due());
  CHECK(row[0] == 2);
  CHECK(row[1] == doctest::Approx(8000));
  CHECK(row[2] == doctest::Approx(3300));
  CHECK(row[4] == doctest::Approx(std::atan(3300.0 / 8000) * 180 / FakeWorld::pi));
  CHECK(row[5] == doctest::Approx(0.01));
  CHECK(row[6] == 1);
  CHECK(row[7] == doctest::Approx(0.1 * 0.01 * std::sqrt(1000 / 8000.0)));
  CHECK(std::isnan(row[8]));  // one point is no line
  run_step(world, *sensor, 3, 5000, 4000, 0.05);
  row = sensor->sample(world);
  CHECK(row[6] == 0);
  FakeState state;
  run_step(world, *sensor, 4, 4000, 1700, 0);
  sensor->save(state, "s");
  sensor = world.sensor(json, "wall-friction");
  sensor->load(state, "s");
  CHECK(sensor->row_due());
  run_step(world, *sensor, 5, 2000, 900, 0);
  row = sensor->sample(world);
  CHECK(row[8] == doctest::Approx(std::atan(0.4) * 180 / FakeWorld::pi));
  CHECK(row[10] == doctest::Approx(100));
  CHECK(row[11] < 1e-6);
  CHECK(sensor->sample(world) == row);  // between two steps the last one again
}

// Load and shear fall together within the windows compared: the friction is steady all the same.
TEST_CASE("a load that has just changed is no drift of friction") {
  FakeWorld world = coupon();
  const auto sensor = world.sensor(json, "wall-friction");
  for (int k = 0; k < 80; ++k) {
    const double normal = k < 65 ? 8000 : 5000;
    world.loads[0].force = {-0.5 * 0.4 * normal, 0, -0.5 * normal};
    world.cycles["lid"] = k < 39 ? 0.5 : k < 79 ? 1 : 2;
    sensor->step(world);
  }
  CHECK(sensor->sample(world)[5] < 1e-12);
}

TEST_CASE("without a motion there are no steps") {
  CHECK(coupon().error_of(R"({"parts": ["coupon"], "area": 1})", "wall-friction").find("needs \"motion\"") !=
        std::string::npos);
}
