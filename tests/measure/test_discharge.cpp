#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.001, d = 2 * radius;
constexpr double grain = 4 * FakeWorld::pi / 3 * 1e-6;  // kg, of one sphere of 1000 kg/m^3
const char* const slot = R"({"region": "vessel", "bed": "bed", "opening": "slot", "width": 0.015, "length": 0.05})";
const char* const circle = R"({"region": "vessel", "bed": "bed", "opening": "circle", "width": 0.036})";

enum Column { mass, retained, rate, rate_sd, r2, pause, density, size, beverloo, ratio };

/// 1000 grains in a vessel, 500 of them in the bed, a box of 10 cm3.
FakeWorld full_vessel() {
  FakeWorld world;
  world.add_box("vessel", {0, 0, 0}, {1, 1, 1});
  world.add_box("bed", {0.1, 0.1, 0.1}, {0.11, 0.2, 0.11});
  for (int k = 0; k < 1000; ++k)
    world.add_sphere(k < 500 ? Vec3{0.105, 0.101 + 0.00019 * k, 0.105} : Vec3{0.5, 0.5, 0.5}, radius);
  return world;
}

/// Takes the last grains that are still in the vessel out of it and lets time pass.
void leave(FakeWorld& world, int count, double seconds) {
  for (std::size_t p = world.grains.count(); p-- > 0 && count > 0;)
    if (world.grains.body[p].z > 0) world.move(p, {0, 0, -5}), --count;
  world.now += seconds;
}

}  // namespace

TEST_CASE("a steady discharge has its rate, no pause and no scatter") {
  FakeWorld world = full_vessel();
  const auto sensor = world.sensor(slot, "discharge");
  auto row = sensor->sample(world);
  CHECK(row[mass] == 0);
  CHECK(row[retained] == doctest::Approx(1000 * grain));
  CHECK(std::isnan(row[rate]));
  for (int k = 0; k < 80; ++k) leave(world, 10, 0.01), row = sensor->sample(world);
  CHECK(row[mass] == doctest::Approx(800 * grain));
  CHECK(row[retained] == doctest::Approx(200 * grain));
  CHECK(row[rate] == doctest::Approx(1000 * grain));
  CHECK(row[rate_sd] < 1e-9 * row[rate]);
  CHECK(row[r2] == doctest::Approx(1));
  CHECK(row[pause] == 0);
}

TEST_CASE("the estimate for a slot and a circle is Beverloo's for the bed's density and the grains' size") {
  FakeWorld world = full_vessel();
  // By hand: 500 grains in 1e-5 m3, d 2 mm, k d = 2.8 mm.
  const double bulk = 500 * grain / 1e-5, root = std::sqrt(9.81);
  auto row = world.sensor(slot, "discharge")->sample(world);
  CHECK(row[density] == doctest::Approx(bulk));
  CHECK(row[size] == doctest::Approx(d));
  CHECK(row[beverloo] == doctest::Approx(1.03 * bulk * root * 0.05 * std::pow(0.0122, 1.5)));
  row = world.sensor(circle, "discharge")->sample(world);
  CHECK(row[beverloo] == doctest::Approx(0.58 * bulk * root * std::pow(0.0332, 2.5)));
  const auto narrow = R"({"region": "vessel", "bed": "bed", "opening": "circle", "width": 0.0028})";
  CHECK(world.sensor(narrow, "discharge")->sample(world)[beverloo] == 0);
}

TEST_CASE("published figures of the paper's slot: 0.354 kg/s for 0.1 mm powder, 0.241 for spheres of 2.5 mm") {
  for (const auto& [diameter, expected] : {std::pair<double, double>{1e-4, 0.354}, {2.5e-3, 0.241}}) {
    FakeWorld world;
    world.add_box("vessel", {-1, -1, -1}, {1, 1, 1});
    const double each = FakeWorld::pi / 6 * diameter * diameter * diameter;
    // One grain in a bed just as large that its mass makes 1210 kg/m3.
    const double side = std::cbrt(1000 * each / 1210);
    world.add_box("bed", {-side / 2, -side / 2, -side / 2}, {side / 2, side / 2, side / 2});
    world.add_sphere({0, 0, 0}, diameter / 2);
    auto row = world.sensor(slot, "discharge")->sample(world);
    // The bed cuts the sphere's caps off; its estimate is in proportion to the density found.
    CHECK(row[beverloo] * 1210 / row[density] == doctest::Approx(expected).epsilon(0.002));
  }
}

TEST_CASE("a stoppage is seen as a pause and as scatter") {
  FakeWorld world = full_vessel();
  const auto sensor = world.sensor(slot, "discharge");
  std::vector<double> row = sensor->sample(world);
  for (int k = 0; k < 100; ++k) leave(world, k >= 45 && k < 55 ? 0 : 8, 0.01), row = sensor->sample(world);
  CHECK(row[pause] == doctest::Approx(0.1));
  CHECK(row[rate_sd] > 0.2 * row[rate]);
}

TEST_CASE("what is poured in later moves the start; a resumed sensor goes on to the same numbers") {
  FakeWorld world = full_vessel();
  const auto sensor = world.sensor(slot, "discharge");
  sensor->sample(world);
  leave(world, 5, 0.01);
  CHECK(sensor->sample(world)[mass] == doctest::Approx(5 * grain));
  for (int k = 0; k < 50; ++k) world.add_sphere({0.5, 0.5, 0.5}, radius);
  CHECK(sensor->sample(world)[mass] == 0);
  for (int k = 0; k < 30; ++k) leave(world, 10, 0.01), sensor->sample(world);
  FakeState state;
  sensor->save(state, "s");
  const auto resumed = world.sensor(slot, "discharge");
  resumed->load(state, "s");
  for (int k = 0; k < 20; ++k) {
    leave(world, 10, 0.01);
    CHECK(sensor->sample(world) == resumed->sample(world));
  }
  const auto curves = resumed->curves();
  CHECK(curves.at(0).x.size() == 51);
  CHECK(curves.at(1).name == "middle half");
  CHECK(curves.at(2).y.size() == 2);
}

TEST_CASE("wrong keys of a discharge are named") {
  FakeWorld world = full_vessel();
  CHECK(
      world.error_of(R"({"region": "vessel"})", "discharge") ==
      "case.json /sensors/0: sensor \"probe\" of kind discharge needs \"bed\", one of the regions \"vessel\", \"bed\"");
  CHECK(world.error_of(R"({"region": "vessel", "bed": "bed", "width": 0.01})", "discharge") ==
        "case.json /sensors/0: sensor \"probe\" of kind discharge needs \"length\", a number in m");
  CHECK(world.error_of(R"({"region": "vessel", "bed": "bed", "width": 0.01, "length": 1, "from": 0.8})", "discharge") ==
        "case.json /sensors/0/from: the share at which the fit begins must be below \"to\"");
}
