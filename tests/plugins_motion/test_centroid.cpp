// calx.centroid: centre of mass of particles in a box.
#include <cmath>

#include "loaded_plugin.hpp"

using namespace calx_test;

namespace {

const char library[] = "calx_centroid", id[] = "calx.centroid";

std::vector<double> sample(const LoadedPlugin& p, const std::vector<double>& x, const std::vector<double>& z,
                           const std::vector<double>& mass) {
  const std::vector<double> zero(x.size(), 0.0);
  std::vector<std::uint32_t> ids;
  for (std::size_t k = 0; k < x.size(); ++k) ids.push_back(static_cast<std::uint32_t>(k));
  const double* o = zero.data();
  const calx_sensor_view view = {sizeof(calx_sensor_view),
                                 0,
                                 x.size(),
                                 1.5,
                                 ids.data(),
                                 x.data(),
                                 o,
                                 z.data(),
                                 o,
                                 o,
                                 o,
                                 o,
                                 o,
                                 o,
                                 mass.data(),
                                 o,
                                 nullptr,
                                 0};
  const calx_sensor* table = p.table<calx_sensor>(CALX_SENSOR);
  std::vector<double> out(table->output_count, -1);
  REQUIRE(table->sample(p.instance(), p.host(), &view, out.data()) == CALX_OK);
  return out;
}

}  // namespace

TEST_CASE("the centre is weighted by mass") {
  const LoadedPlugin p(library, id);
  const auto out = sample(p, {-1, 1, 3}, {0, 2, 4}, {3, 1, 0.5});
  REQUIRE(out.size() == 4);
  CHECK(out[0] == doctest::Approx((-3 + 1 + 1.5) / 4.5));
  CHECK(out[1] == 0);
  CHECK(out[2] == doctest::Approx((2 + 2) / 4.5));
  CHECK(out[3] == 4.5);
}

TEST_CASE("only particles in the box count, and an empty box has no centre") {
  const LoadedPlugin p(library, id, {{"min_z", 1}, {"max_z", 3}});
  const auto out = sample(p, {-1, 1, 3}, {0, 2, 4}, {3, 1, 0.5});
  CHECK(out[0] == 1);
  CHECK(out[3] == 1);
  const auto none = sample(p, {-1}, {0}, {3});
  CHECK(std::isnan(none[0]));
  CHECK(none[3] == 0);
  CHECK(sample(p, {}, {}, {})[3] == 0);
}

TEST_CASE("the output table names and measures its columns") {
  const LoadedPlugin p(library, id);
  const calx_sensor* table = p.table<calx_sensor>(CALX_SENSOR);
  CHECK(std::string(table->output[0].name) == "x");
  CHECK(std::string(table->output[0].unit) == "m");
  CHECK(std::string(table->output[3].name) == "mass");
  CHECK(std::string(table->output[3].unit) == "kg");
}

TEST_CASE("a box without inside is refused") {
  CHECK(refusal(library, id, {{"min_y", 2}, {"max_y", 2}}) ==
        "min: its y is not below that of max, so the box has no inside; give min < max");
}
