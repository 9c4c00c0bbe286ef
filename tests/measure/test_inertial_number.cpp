#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

constexpr double radius = 0.001, d = 2 * radius;

/// A cubic packing of 10 x 10 x 10 spheres of 1000 kg/m3 whose velocity is linear in the place.
FakeWorld bed(double shear, double spin, double squeeze) {
  FakeWorld world;
  world.add_box("bed", {-1, -1, -1}, {1, 1, 1});
  for (int k = 0; k < 1000; ++k) {
    const Vec3 at{d * (k % 10), d * (k / 10 % 10), d * (k / 100)};
    // Simple shear dvx/dz, a rigid turn about y, and a uniform expansion.
    world.add_sphere(at, radius,
                     {shear * at.z + spin * at.z + squeeze * at.x + 0.3, squeeze * at.y, squeeze * at.z - spin * at.x});
  }
  return world;
}

}  // namespace

TEST_CASE("simple shear has its rate and the inertial number of its pressure; turns and expansion have none") {
  for (const auto& [spin, squeeze] : {std::pair<double, double>{0, 0}, {5, 0}, {0, 4}, {2, -3}}) {
    const FakeWorld world = bed(3, spin, squeeze);
    const auto row = world.sensor(R"({"region": "bed"})", "inertial-number")->sample(world);
    // By hand: ten layers of cubes of side d, half of the weight over their footprint.
    const double pressure = 10 * 1000 * FakeWorld::pi / 6 * d * 9.81 / 2;
    CHECK(row[1] == doctest::Approx(3));
    CHECK(row[2] == doctest::Approx(pressure));
    CHECK(row[3] == doctest::Approx(d));
    CHECK(row[0] == doctest::Approx(3 * d * std::sqrt(1000 / pressure)));
    CHECK(row[4] == row[0]);
  }
}

TEST_CASE("the largest number counts from the start event and survives a restart") {
  FakeWorld fast = bed(8, 0, 0), slow = bed(1, 0, 0);
  for (FakeWorld* world : {&fast, &slow}) world->case_settings.events.push_back({"lift", {}});
  const auto sensor = fast.sensor(R"({"region": "bed", "start": "lift"})", "inertial-number");
  CHECK(std::isnan(sensor->sample(fast)[4]));
  slow.events["lift"] = 0;
  const double low = sensor->sample(slow)[0];
  FakeState state;
  sensor->save(state, "s");
  const auto resumed = slow.sensor(R"({"region": "bed", "start": "lift"})", "inertial-number");
  resumed->load(state, "s");
  CHECK(resumed->sample(slow)[4] == low);
  fast.events["lift"] = 0;
  CHECK(resumed->sample(fast)[4] == doctest::Approx(8 * low));
  CHECK(resumed->sample(slow)[4] == doctest::Approx(8 * low));
}

TEST_CASE("too few grains have no inertial number") {
  FakeWorld world;
  world.add_box("bed", {-1, -1, -1}, {1, 1, 1});
  for (int k = 0; k < 9; ++k) world.add_sphere({0.01 * k, 0, 0}, radius);
  CHECK(std::isnan(world.sensor(R"({"region": "bed"})", "inertial-number")->sample(world)[0]));
}
