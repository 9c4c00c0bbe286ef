#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

FakeWorld cell() {
  FakeWorld world;
  world.dt = 1e-3;
  world.add_part("lid");
  world.add_part("cup");
  world.add_motion("press", "");
  world.add_cylinder("bed", {0, 0, 0}, {0, 0, 1}, 0.5);
  return world;
}
/// The lid at a height below its place as drawn, with a load; ends step `number`.
std::vector<double> load(FakeWorld& world, Sensor& sensor, double number, double down, double force) {
  world.poses[0].shift = {0, 0, -down};
  world.loads[0].force = {0, 0, force};
  for (int k = 0; k < 40; ++k) {
    world.cycles["press"] = k == 39 ? number : number - 0.5;
    sensor.step(world);
  }
  CHECK(sensor.row_due());
  return sensor.sample(world);
}

}  // namespace

TEST_CASE("density, height and compressibility under a lid") {
  FakeWorld world = cell();
  world.add_sphere({0, 0, 0.2}, 0.1);  // 4.18879 kg
  world.add_sphere({3, 0, 0.2}, 0.1);  // outside
  const char* const json =
      R"({"motion": "press", "lid": "lid", "height": 0.5, "area": 0.8, "region": "bed", "window": 0.01})";
  auto sensor = world.sensor(json, "cell-density");
  CHECK(sensor->columns()[4] == "density_kg_m3");
  CHECK(std::isnan(sensor->sample(world)[4]));
  world.poses[0].velocity = {0, 0, -0.02};
  auto row = load(world, *sensor, 1, 0.1, 80);
  CHECK(row[0] == 1);
  CHECK(row[1] == doctest::Approx(100));
  CHECK(row[2] == doctest::Approx(0.4));
  CHECK(row[3] == doctest::Approx(0.32));
  CHECK(row[4] == doctest::Approx(4.18879 / 0.32));
  CHECK(row[5] == doctest::Approx(4.18879e-3 / 0.32));
  CHECK(row[6] == 0);
  CHECK(row[7] == 0);
  CHECK(row[8] == doctest::Approx(0.02));
  // rate 0.02 / 0.4, d 0.2 m, density 1000 kg/m^3, 100 Pa
  CHECK(row[9] == doctest::Approx(0.05 * 0.2 * std::sqrt(10.0)));
  FakeState state;
  sensor->save(state, "s");
  sensor = world.sensor(json, "cell-density");
  sensor->load(state, "s");
  row = load(world, *sensor, 2, 0.14, 800);
  CHECK(row[1] == doctest::Approx(1000));
  CHECK(row[6] == doctest::Approx(10));  // 0.4 -> 0.36
  // The floor that moves along does not count.
  const auto on_floor =
      world.sensor(R"({"motion": "press", "lid": "lid", "floor": "cup", "height": 0.5, "area": 0.8, "window": 0.01})",
                   "cell-density");
  world.poses[1].shift = {0, 0, -0.04};
  CHECK(load(world, *on_floor, 3, 0.14, 80)[2] == doctest::Approx(0.4));
}

// Spheres side by side on a square lattice, tops at 0.2 m: what the envelope misses between spheres lies below, so the
// mean height lies between the middle and the top of the spheres.
TEST_CASE("without a lid the height is that of the surface over the whole region") {
  FakeWorld world = cell();
  for (int i = -6; i <= 6; ++i)
    for (int j = -6; j <= 6; ++j) world.add_sphere({0.1 * i, 0.1 * j, 0.15}, 0.05);
  world.case_settings.regions[0].kind = RegionSettings::Kind::box;
  world.case_settings.regions[0].a = {-0.5, -0.5, 0};
  world.case_settings.regions[0].b = {0.5, 0.5, 1};
  const auto sensor = world.sensor(R"({"motion": "press", "region": "bed", "area": 1})", "cell-density");
  sensor->step(world);
  CHECK(!sensor->row_due());
  world.cycles["press"] = 0.01;
  sensor->step(world);
  CHECK(sensor->row_due());
  const auto poured = sensor->sample(world);
  CHECK(poured[0] == 0);
  CHECK(poured[4] > 0);
  world.cycles["press"] = 0.02;
  sensor->step(world);
  CHECK(!sensor->row_due());
  world.cycles["press"] = 1;
  sensor->step(world);
  const auto row = sensor->sample(world);
  CHECK(row[0] == 1);
  CHECK(row[4] == poured[4]);
  CHECK(std::isnan(row[1]));
  CHECK(row[2] > 0.15);
  CHECK(row[2] < 0.2);
  // Where nothing lies the floor counts: half of the bed is gone.
  FakeWorld half = cell();
  half.case_settings.regions = world.case_settings.regions;
  for (int i = -6; i < 0; ++i)
    for (int j = -6; j <= 6; ++j) half.add_sphere({0.1 * i - 0.05, 0.1 * j, 0.15}, 0.05);
  const auto bare = half.sensor(R"({"motion": "press", "region": "bed", "area": 1})", "cell-density");
  half.cycles["press"] = 1;
  bare->step(half);
  CHECK(bare->sample(half)[2] == doctest::Approx(0.5 * row[2]).epsilon(0.05));
}

TEST_CASE("it needs a lid or a region") {
  CHECK(cell().error_of(R"({"motion": "press", "area": 1})", "cell-density").find("needs \"lid\"") !=
        std::string::npos);
  CHECK(cell().error_of(R"({"motion": "press", "area": 1, "lid": "lid"})", "cell-density").find("needs \"height\"") !=
        std::string::npos);
}
