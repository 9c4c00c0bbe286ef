#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

const char* const json = R"({"parts": ["base"], "area": 2, "motion": "stem", "window": 0.01})";

FakeWorld shear_cell() {
  FakeWorld world;
  world.dt = 1e-3;
  world.add_part("base");
  world.add_motion("stem", "");
  world.add_sphere({0, 0, 0}, 0.1);
  return world;
}
/// A leg of the stem: six windows; shear rises to `peak` in the third and falls to `end`.
std::map<std::string, double> leg(FakeWorld& world, Sensor& sensor, double number, double normal, double peak,
                                  double end) {
  const double shear[] = {0.3 * peak, 0.8 * peak, peak, 0.5 * (peak + end), end, end};
  for (int k = 0; k < 60; ++k) {
    world.loads[0].force = {2 * shear[k / 10], 0, -2 * normal};
    world.cycles["stem"] = k == 59 ? number : number - 0.5;
    sensor.step(world);
  }
  std::map<std::string, double> out;
  const auto row = sensor.sample(world);
  const auto columns = sensor.columns();
  REQUIRE(row.size() == columns.size());
  for (std::size_t k = 0; k < row.size(); ++k) out[columns[k]] = row[k];
  return out;
}

}  // namespace

// Locus 500 + normal tan 30 deg, pre-shear at 8000 Pa: every figure follows by hand, see test_locus.
TEST_CASE("pre-shear counts at its end, failure at its peak, prorated to the mean pre-shear") {
  FakeWorld world = shear_cell();
  auto sensor = world.sensor(json, "yield-locus");
  const double tangent = std::tan(FakeWorld::pi / 6);
  const auto yield = [&](double normal) { return 500 + normal * tangent; };
  auto row = leg(world, *sensor, 1, 8000, 5200, 5000);
  CHECK(row["role_1"] == 1);
  CHECK(row["shear_Pa"] == doctest::Approx(5000));
  CHECK(row["steady_1"] == 1);
  row = leg(world, *sensor, 2, 8000, 0, 0);
  CHECK(row["role_1"] == 0);
  row = leg(world, *sensor, 3, 6000, yield(6000), 3000);
  CHECK(row["role_1"] == 2);
  CHECK(row["shear_Pa"] == doctest::Approx(yield(6000)));
  CHECK(row["prorated_Pa"] == doctest::Approx(yield(6000)));
  CHECK(std::isnan(row["phi_deg"]));
  // A sample made too strong by 10 %: its point comes down, all to the mean of both pre-shears, 5250 Pa.
  leg(world, *sensor, 4, 8000, 5800, 5500);
  leg(world, *sensor, 5, 8000, 0, 0);
  FakeState state;
  sensor->save(state, "s");
  sensor = world.sensor(json, "yield-locus");
  sensor->load(state, "s");
  row = leg(world, *sensor, 6, 3000, 1.1 * yield(3000), 1000);
  CHECK(row["shear_Pa"] == doctest::Approx(1.1 * yield(3000)));
  CHECK(row["prorated_Pa"] == doctest::Approx(1.05 * yield(3000)));
  CHECK(row["level_1"] == 1);
  CHECK(row["phi_deg"] == doctest::Approx(std::atan(1.05 * tangent) * 180 / FakeWorld::pi));
  CHECK(row["cohesion_Pa"] == doctest::Approx(1.05 * 500));
  CHECK(row["strength_Pa"] > 0);
  CHECK(row["ffc_1"] == doctest::Approx(row["sigma1_Pa"] / row["strength_Pa"]));
  CHECK(row["steady_deg"] == doctest::Approx(std::atan(5250.0 / 8000) * 180 / FakeWorld::pi));
}

TEST_CASE("another stress of pre-shear begins another locus") {
  FakeWorld world = shear_cell();
  const auto sensor = world.sensor(R"({"parts": ["base"], "area": 2, "motion": "stem", "window": 0.01, "prorate": false,
                                       "pattern": ["pre-shear", "shear"]})",
                                   "yield-locus");
  leg(world, *sensor, 1, 8000, 5000, 5000);
  leg(world, *sensor, 2, 6000, 4000, 3000);
  leg(world, *sensor, 3, 9500, 5000, 5000);
  auto row = leg(world, *sensor, 4, 4000, 3000, 3000);
  CHECK(row["level_1"] == 1);
  CHECK(row["phi_deg"] == doctest::Approx(std::atan(0.5) * 180 / FakeWorld::pi));
  leg(world, *sensor, 5, 16000, 9000, 9000);
  row = leg(world, *sensor, 6, 12000, 8000, 8000);
  CHECK(row["level_1"] == 2);
  CHECK(std::isnan(row["phi_deg"]));
  leg(world, *sensor, 7, 16000, 9000, 9000);
  row = leg(world, *sensor, 8, 8000, 6000, 6000);
  CHECK(row["cohesion_Pa"] == doctest::Approx(2000));
}

TEST_CASE("a pre-shear that still rises is not steady") {
  FakeWorld world = shear_cell();
  const auto sensor =
      world.sensor(R"({"parts": ["base"], "area": 2, "motion": "stem", "window": 0.02})", "yield-locus");
  const auto row = leg(world, *sensor, 1, 8000, 5000, 7000);
  CHECK(row.at("drift_1") == doctest::Approx((7000 - 5500) / 7000.0));
  CHECK(row.at("steady_1") == 0);
}

TEST_CASE("an unknown part of the pattern is refused") {
  CHECK(shear_cell().error_of(R"({"parts": ["base"], "area": 1, "motion": "stem", "pattern": ["preshear"]})",
                              "yield-locus") ==
        "case.json /sensors/0/pattern/0: unknown choice \"preshear\"; did you mean \"pre-shear\"?");
}
