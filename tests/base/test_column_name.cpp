#include <doctest/doctest.h>

#include <utility>

#include "base/column_name.hpp"

namespace calx {

TEST_CASE("the unit of a column is what its name ends in") {
  const std::pair<const char*, const char*> cases[] = {{"mass_kg", "kg"},
                                                       {"density_kg_m3", "kg/m^3"},
                                                       {"rate_kg_s", "kg/s"},
                                                       {"flux_kg_m2_s", "kg/(m^2 s)"},
                                                       {"torque_x_N_m", "N m"},
                                                       {"left_sd_deg", "deg"},
                                                       {"height_min_m", "m"},
                                                       {"share_1", "1"},
                                                       {"strain_percent", "%"},
                                                       {"stress_kPa", "kPa"},
                                                       {"time_min", "min"},
                                                       {"speed_rpm", "rpm"},
                                                       {"kg", ""},
                                                       {"mass", ""},
                                                       {"angle_degree", ""}};
  for (const auto& c : cases) {
    CAPTURE(c.first);
    CHECK(split_column(c.first).unit == c.second);
  }
  CHECK(split_column("torque_x_N_m").quantity == "torque_x");
  CHECK(split_column("height_min_m").quantity == "height_min");
  CHECK(split_column("kg").quantity == "kg");
}

}  // namespace calx
