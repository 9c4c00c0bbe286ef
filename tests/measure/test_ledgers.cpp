#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "measure/fake_world.hpp"

using namespace calx;

namespace {

double value(const Sensor& sensor, const std::vector<double>& row, const std::string& column) {
  const std::vector<std::string> names = sensor.columns();
  const auto it = std::find(names.begin(), names.end(), column);
  REQUIRE_MESSAGE(it != names.end(), column);
  return row.at(static_cast<std::size_t>(it - names.begin()));
}

}  // namespace

TEST_CASE("the energy ledger's columns carry its figures and the share of the remainder") {
  FakeWorld world;
  const auto sensor = world.sensor("{}", "energy");
  CHECK(std::isnan(sensor->sample(world)[0]));
  world.energies = {true, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, -0.5, 20};
  const auto row = sensor->sample(world);
  const std::pair<const char*, double> expected[] = {{"kinetic_translation_J", 1},
                                                     {"kinetic_rotation_J", 2},
                                                     {"gravity_J", 3},
                                                     {"elastic_J", 4},
                                                     {"friction_J", 5},
                                                     {"damping_J", 6},
                                                     {"plastic_J", 7},
                                                     {"wall_work_J", 8},
                                                     {"force_work_J", 9},
                                                     {"inserted_J", 10},
                                                     {"removed_J", 11},
                                                     {"remainder_J", -0.5},
                                                     {"work_done_J", 20},
                                                     {"remainder_share_1", 0.025}};
  for (const auto& e : expected) CHECK(value(*sensor, row, e.first) == e.second);
  world.energies.work_done = 0;
  CHECK(value(*sensor, sensor->sample(world), "remainder_share_1") == 0);
}

TEST_CASE("the mass ledger places every particle once and closes to the particle") {
  FakeWorld world;
  world.add_box("Hopper 1", {0, 0, 1}, {1, 1, 2});
  world.add_box("throat", {0, 0, 0.5}, {1, 1, 1.2});
  world.add_box("canister", {0, 0, 0}, {1, 1, 0.5});
  for (double z : {1.1, 1.5, 0.7, 0.2, 0.3, 5.0}) world.add_sphere({0.5, 0.5, z}, 0.01);
  const double grain = world.grains.body[0].m;
  world.masses = {8, 6, 2, 8 * grain, 6 * grain, 2 * grain, 9 * grain, 8 * grain};
  const auto sensor = world.sensor("{}", "mass-ledger");
  auto row = sensor->sample(world);
  CHECK(value(*sensor, row, "in_hopper_1_1") == 2);
  CHECK(value(*sensor, row, "in_throat_1") == 1);
  CHECK(value(*sensor, row, "in_canister_1") == 2);
  CHECK(value(*sensor, row, "in_canister_kg") == doctest::Approx(2 * grain));
  CHECK(value(*sensor, row, "elsewhere_1") == 1);
  CHECK(value(*sensor, row, "lost_1") == 2);
  CHECK(value(*sensor, row, "lost_kg") == doctest::Approx(2 * grain));
  CHECK(value(*sensor, row, "requested_kg") == doctest::Approx(9 * grain));
  CHECK(value(*sensor, row, "delivered_kg") == doctest::Approx(8 * grain));
  CHECK(value(*sensor, row, "imbalance_1") == 0);
  world.erase(0);  // gone without being booked
  row = sensor->sample(world);
  CHECK(value(*sensor, row, "imbalance_1") == 1);
}

TEST_CASE("the mass ledger takes the regions listed, in their order, but not two of one column") {
  FakeWorld world;
  world.add_box("a b", {0, 0, 0}, {1, 1, 1});
  world.add_box("a_b", {0, 0, 0}, {1, 1, 1});
  world.add_box("c", {0, 0, 0}, {1, 1, 1});
  world.add_box("sensor x", {0, 0, 0}, {1, 1, 1}).is_named = false;
  const auto sensor = world.sensor(R"({"regions": ["c", "a b"]})", "mass-ledger");
  CHECK(sensor->columns()[6] == "in_c_1");
  CHECK(sensor->columns()[8] == "in_a_b_1");
  CHECK(
      world.error_of("{}", "mass-ledger") ==
      "case.json /sensors/0/regions: regions \"a b\" and \"a_b\" would share the column in_a_b_kg; list one, or rename "
      "one");
  CHECK(world.error_of(R"({"regions": ["d"]})", "mass-ledger") ==
        "case.json /sensors/0/regions/0: unknown region \"d\"; known are \"a b\", \"a_b\", \"c\", \"sensor x\"");
  CHECK(world.error_of(R"({"regions": "c"})", "mass-ledger") ==
        "case.json /sensors/0/regions: \"c\" is not an array of region names");
}
