// A study that is right: values, units, scatter and requests as they must come out of the example's files.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "io/scratch.hpp"
#include "study/study.hpp"

namespace calx {
namespace {

const std::string kExample = CALX_SOURCE_DIR "/examples/calibration/study.json";

std::string value_at(const RunRequest& request, const std::string& pointer) {
  std::string out;
  for (const auto& o : request.overrides)
    if (o.first == pointer) out = o.second;
  return out;
}

}  // namespace

TEST_CASE("the example's data are read with their scatter") {
  const Study s = read_study(kExample, {CALX_PLUGIN_DIR});
  REQUIRE(s.observables.size() == 3);
  const StudyObservable& density = s.observables[0];
  // By hand from density.csv: 1.1421, 1.1456, 1.1554, 1.1525, 1.1482.
  CHECK(density.measured.y[0] == doctest::Approx(1.14876));
  CHECK(density.measured.sd[0] == doctest::Approx(0.005309).epsilon(1e-3));
  CHECK(density.measured.repeats == 5);
  CHECK(density.measured.sd_estimated);
  CHECK(density.factor == doctest::Approx(1e-3));  // kg/m^3 in g/cm^3
  CHECK(density.tolerance == doctest::Approx(0.35 * 0.005309).epsilon(1e-3));
  const StudyObservable& mass = s.observables[1];
  CHECK(mass.measured.x == std::vector<double>{0.3, 0.4, 0.5, 0.6, 0.78});
  CHECK(mass.measured.y[0] == doctest::Approx((15.621 + 15.615 + 15.878 + 15.630 + 15.957) / 5));
  CHECK(mass.measured.correlation == 0.5);
  CHECK(mass.use == StudyObservable::Use::fit);
  CHECK(s.observables[2].use == StudyObservable::Use::hold_out);
  CHECK(s.observables[2].against.empty());
  CHECK(s.seeds == 2);
  CHECK(s.budget == 40);
}

TEST_CASE("a request holds the case's settings, then the parameters in SI, or in degrees where the key says so") {
  const Study example = read_study(kExample, {CALX_PLUGIN_DIR});
  Study s = example;
  s.cases[0].set = {{"/time/end", "0.5"}};
  s.cases[0].reduced = "coarse.json";
  s.parameters[0].unit = "MPa";
  s.parameters[1].unit = "deg";
  s.parameters[1].set = {"/a/swing_deg", "/a/swing"};
  const RunRequest q = request_for(s, s.cases[0], {2.5, 90}, 7);
  CHECK(q.seed == 7);
  CHECK(q.overrides[0].first == "/time/end");
  CHECK(std::stod(value_at(q, "/contacts/0/parameters/friction")) == doctest::Approx(2.5e6));
  CHECK(value_at(q, "/a/swing_deg") == "90");
  CHECK(std::stod(value_at(q, "/a/swing")) == doctest::Approx(1.5707963267948966));
  CHECK(q.case_path == s.cases[0].path);
  CHECK(request_for(s, s.cases[0], {1, 1}, 7, true).case_path == "coarse.json");
  // A parameter of another case is not set in this one.
  s.parameters[0].cases = {"other"};
  CHECK(value_at(request_for(s, s.cases[0], {2.5, 90}, 7), "/contacts/0/parameters/friction").empty());
}

TEST_CASE("files in other units are converted, noise has an absolute and a relative part, repeats may be single") {
  const calx_test::Scratch scratch;
  std::ofstream(scratch / "curve.csv") << "time_ms,mass_mg\n300,15000\n400,12000\n";
  std::ofstream(scratch / "study.json") << R"({"calx_study": 1, "cases": {"hopper": {"case": ")" << CALX_SOURCE_DIR
                                        << R"(/examples/calibration/slot_hopper.json"}},
    "parameters": [{"name": "f", "range": [0.1, 0.8], "set": ["/contacts/0/parameters/friction"]}],
    "observables": [{"name": "m", "kind": "hopper-discharge", "case": "hopper", "sensor": "in hopper", "column": "mass_kg",
      "against": "time_s", "unit": "g", "tolerance": {"value": 50, "unit": "mg"},
      "measured": {"file": "curve.csv", "x": "time_ms", "y": "mass_mg", "sd": 0.3, "relative": 0.02}}]})";
  const Study s = read_study(scratch / "study.json", {CALX_PLUGIN_DIR});
  const MeasuredData& m = s.observables[0].measured;
  CHECK(m.x[0] == doctest::Approx(0.3));
  CHECK(m.y[1] == doctest::Approx(12));
  CHECK(m.sd[0] == doctest::Approx(std::hypot(0.3, 0.02 * 15)));
  CHECK(m.repeats == 1);
  CHECK_FALSE(m.sd_estimated);
  CHECK(s.observables[0].factor == doctest::Approx(1000));
  CHECK(s.observables[0].tolerance == doctest::Approx(0.05));
}

TEST_CASE("the scatter of a curve is that of its repeats, place by place where it differs, with their correlation") {
  const calx_test::Scratch scratch;
  std::ofstream file(scratch / "curve.csv");
  file << "run,time_s,mass_g\n";
  // Repeats whose departures are 1, -1, 2, -2 of a shape that is 0.01 at first and 0.1 later: each place has the sd of
  // these, 1.826, times the shape. Three degrees of freedom draw the sd together, and neighbours go together.
  const double away[] = {1, -1, 2, -2};
  for (int r = 0; r < 4; ++r)
    for (int k = 0; k < 12; ++k)
      file << r << ',' << 0.3 + 0.01 * k << ',' << 5 + away[r] * (k < 6 ? 0.01 : 0.1) << '\n';
  file.close();
  std::ofstream(scratch / "study.json") << R"({"calx_study": 1, "cases": {"hopper": {"case": ")" << CALX_SOURCE_DIR
                                        << R"(/examples/calibration/slot_hopper.json"}},
    "parameters": [{"name": "f", "range": [0.1, 0.8], "set": ["/contacts/0/parameters/friction"]}],
    "observables": [{"name": "m", "kind": "hopper-discharge", "case": "hopper", "sensor": "in hopper", "column": "mass_kg",
      "against": "time_s", "unit": "g", "measured": {"file": "curve.csv", "x": "time_s", "y": "mass_g", "repeat": "run"}}]})";
  const MeasuredData m = read_study(scratch / "study.json", {CALX_PLUGIN_DIR}).observables[0].measured;
  CHECK(m.sd_estimated);
  const double all = std::sqrt(10.0 / 3 * (0.01 * 0.01 + 0.1 * 0.1) / 2);
  CHECK(m.sd[0] < 0.85 * all);
  CHECK(m.sd[11] > 1.1 * all);
  // Certain correlation, drawn to none by the weight of 10 numbers against 33.
  CHECK(m.correlation == doctest::Approx(33.0 / 43).epsilon(0.1));
}

TEST_CASE("a curve of a sensor is as good as its columns") {
  const calx_test::Scratch scratch;
  const auto study = [&](const std::string& against) {
    std::ofstream(scratch / "study.json")
        << R"({"calx_study": 1, "cases": {"hopper": {"case": ")" << CALX_SOURCE_DIR
        << R"(/examples/calibration/slot_hopper.json", "set": {
      "/sensors": [{"name": "bed", "kind": "height-map", "region": "hopper", "cell": 0.01, "every": 0.1}]}}},
      "parameters": [{"name": "f", "range": [0.1, 0.8], "set": ["/contacts/0/parameters/friction"]}],
      "observables": [{"name": "h", "kind": "pile-profile", "case": "hopper", "sensor": "bed", "column": "height_m",
        "against": ")"
        << against << R"(", "unit": "mm", "at": [0.01, 0.02], "measured": {"values": [1, 2], "sd": 1}}]})";
    return read_study(scratch / "study.json", {CALX_PLUGIN_DIR});
  };
  CHECK(study("x_m").observables[0].factor == doctest::Approx(1000));
  CHECK(study("radius_m").observables[0].measured.x == std::vector<double>{0.01, 0.02});
  // height_m is a curve over places, no column over time.
  CHECK_THROWS_WITH_AS(study("time_s"), doctest::Contains("has no column \"height_m\""), Error);
}

}  // namespace calx
