#include <doctest/doctest.h>

#include <cmath>

#include "measure/fake_state.hpp"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

FakeWorld cell() {
  FakeWorld world;
  world.case_settings.gravity = {0, 0, -10};
  world.add_part("floor");
  world.add_part("ring");
  world.loads[0].force = {3, 0, -20};
  world.loads[1].force = {1, 0.5, -4};
  world.add_cylinder("below", {0, 0, 0}, {0, 0, 1}, 1);
  return world;
}
const char* const json = R"({"parts": ["floor", "ring"], "area": 2, "below": "below"})";

}  // namespace

TEST_CASE("forces of all parts over the area, less the weight of what stands below the plane") {
  FakeWorld world = cell();
  world.add_sphere({0, 0, 0.5}, 0.1);  // 4.18879 kg
  world.add_sphere({0, 0, 1.5}, 0.1);  // above the plane
  const auto sensor = world.sensor(json, "stress");
  CHECK(sensor->columns() == std::vector<std::string>{"normal_Pa", "shear_Pa", "ratio_1"});
  sensor->sample(world);  // looks up the weight
  const auto row = sensor->sample(world);
  CHECK(row[0] == doctest::Approx((24 - 41.8879) / 2));
  CHECK(row[1] == doctest::Approx(2));
  CHECK(std::isnan(row[2]));  // no compression
}

TEST_CASE("a row is the mean over the steps since the row before, also across a restart") {
  FakeWorld world = cell();
  auto sensor = world.sensor(json, "stress");
  for (const double fz : {-20.0, -40.0}) {
    world.loads[0].force.z = fz;
    sensor->step(world);
  }
  FakeState state;
  sensor->save(state, "s");
  sensor = world.sensor(json, "stress");
  sensor->load(state, "s");
  world.loads[0].force.z = -60;
  sensor->step(world);
  const auto row = sensor->sample(world);
  CHECK(row[0] == doctest::Approx(44.0 / 2));
  CHECK(row[2] == doctest::Approx(2.0 / 22));
}

TEST_CASE("directions may be given, a part that is not there carries nothing") {
  FakeWorld world = cell();
  world.present[1] = false;
  const auto row =
      world.sensor(R"({"parts": ["floor", "ring"], "area": 1, "normal": [2, 0, 0], "shear": [0, 0, -3]})", "stress")
          ->sample(world);
  CHECK(row == std::vector<double>{3, 20, 20.0 / 3});
}

TEST_CASE("bad keys are refused") {
  const FakeWorld world = cell();
  CHECK(world.error_of(R"({"area": 1})", "stress") == "case.json /sensors/0: sensor \"probe\" needs \"parts\", a list");
  CHECK(world.error_of(R"({"parts": ["flor"], "area": 1})", "stress") ==
        "case.json /sensors/0/parts/0: unknown part \"flor\"; did you mean \"floor\"?");
  CHECK(world.error_of(R"({"parts": "floor", "area": 1})", "stress").find("is not an array of part names") !=
        std::string::npos);
  CHECK(world.error_of(R"({"parts": ["floor"]})", "stress").find("needs \"area\"") != std::string::npos);
  CHECK(world.error_of(R"({"parts": ["floor"], "area": 1, "shear": [1, 0, 1]})", "stress") ==
        "case.json /sensors/0/shear: must be at a right angle to \"normal\"");
  CHECK(world.error_of(R"({"parts": ["floor"], "area": 1, "normal": [0, 0, 0]})", "stress")
            .find("/normal: has no direction") != std::string::npos);
}
