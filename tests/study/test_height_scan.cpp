// A scanned surface as a few numbers, and the same numbers of a sensor's height map.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "io/scratch.hpp"
#include "study/height_scan.hpp"
#include "study/measured_blocks.hpp"
#include "study/observe.hpp"

namespace calx {
namespace {

/// A pile of 40 mm at the middle that falls by a paraboloid and leans in x; mm, place in mm within 60 x 40.
double surface(double x, double y) { return 40 - 0.01 * x * x - 0.02 * y * y + 0.05 * x; }

/// Its modes over x = -30..30, y = -20..20 by hand: u^2 = (2 P2 + 1) / 3.
constexpr double by_hand[scan_modes] = {40 - 3 - 8.0 / 3, 1.5, 0, -6, 0, -16.0 / 3};

std::string scan(double shift_of_second, const std::string& header = "x_mm,y_mm,z_cm,scan") {
  std::string out = header + "\n";
  for (int repeat = 0; repeat < 2; ++repeat)
    for (int i = -6; i <= 6; ++i)
      for (int j = -4; j <= 4; ++j)
        out += std::to_string(5 * i) + "," + std::to_string(5 * j) + "," +
               std::to_string(0.1 * (surface(5 * i, 5 * j) + repeat * shift_of_second)) + "," + std::to_string(repeat) +
               "\n";
  return out;
}

/// The tray of the DEM tier's pile; its map covers x and y of the region "tray".
Study study_of(
    const calx_test::Scratch& scratch, const std::string& csv, const std::string& observable = "",
    const std::string& measured = R"("file": "scan.csv", "x": "x_mm", "y": "y_mm", "z": "z_cm", "repeat": "scan")") {
  std::ofstream(scratch / "scan.csv") << csv;
  std::ofstream(scratch / "study.json") << R"({"calx_study": 1, "cases": {"pile": {"case": ")" << CALX_SOURCE_DIR
                                        << R"(/tests/diagnosis/dem_tier/rigs/pile.json"}},
    "parameters": [{"name": "f", "range": [0.2, 0.6], "set": ["/contacts/0/parameters/friction"]}],
    "observables": [{"name": "scan", "kind": "pile-profile", "case": "pile", "sensor": "surface", "unit": "mm",)"
                                        << (observable.empty() ? R"("field": "height")" : observable)
                                        << R"(, "measured": {)" << measured << "}}]}";
  return read_study(scratch / "study.json", {CALX_PLUGIN_DIR});
}

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a scan is its mean, slopes, curvatures and twist, with the scatter of its repeats") {
  const calx_test::Scratch scratch;
  const Study s = study_of(scratch, scan(0.6));
  const StudyObservable& o = s.observables[0];
  REQUIRE(o.measured.y.size() == scan_modes);
  // The second repeat is 0.6 mm higher: the mean by 0.3, and only that mode scatters, by 0.6 / sqrt(2).
  for (std::size_t k = 0; k < scan_modes; ++k)
    CHECK(o.measured.y[k] == doctest::Approx(by_hand[k] + (k == 0 ? 0.3 : 0)).epsilon(1e-5).scale(1));
  CHECK(o.measured.sd[0] == doctest::Approx(0.6 / std::sqrt(2.0) / std::sqrt(6.0)).epsilon(1e-4));
  CHECK(o.measured.repeats == 2);
  CHECK(measured_blocks(s).observables.blocks[0].fit.size() == static_cast<Eigen::Index>(scan_modes));
}

TEST_CASE("the sensor's map gives the numbers of the scan where it has its heights") {
  const calx_test::Scratch scratch;
  const Study s = study_of(scratch, scan(0.6));
  // Cells of 5 mm whose middles are the scanned points; m.
  std::string values;
  for (int j = -4; j <= 4; ++j)
    for (int i = -6; i <= 6; ++i)
      values +=
          (values.empty() ? "" : ",") + (i == 2 && j == 1 ? "null" : std::to_string(1e-3 * surface(5 * i, 5 * j)));
  const auto write = [&](const std::string& origin) {
    std::ofstream(scratch / "fields.json")
        << R"({"curves": [], "fields": [{"sensor": "surface", "name": "height", "unit": "m",
      "nx": 13, "ny": 9, "origin": [)"
        << origin << R"(, 0], "cell": 0.005, "values": [)" << values << "]}]}";
  };
  write("-0.0325, -0.0225");
  const std::vector<double> modes = observe(scratch / "", s.observables[0]);
  REQUIRE(modes.size() == scan_modes);
  // std::to_string keeps a thousandth of a mm.
  for (std::size_t k = 0; k < scan_modes; ++k) CHECK(modes[k] == doctest::Approx(by_hand[k]).epsilon(1e-3).scale(1));
  write("-0.0225, -0.0225");
  const std::string outside = refusal([&] { observe(scratch / "", s.observables[0]); });
  CHECK(says(outside,
             "observable \"scan\": the scanned point (-0.03, -0.02) m lies outside of the map of sensor \"surface\""));
  CHECK(says(outside, "x from -0.0225 to 0.0425 m"));
}

TEST_CASE("a map with too few cells filled gives no number") {
  HeightScan frame;
  frame.low_x = frame.low_y = -1, frame.high_x = frame.high_y = 1;
  std::vector<double> x, y, z;
  for (int k = 0; k < 40; ++k) x.push_back(std::cos(k)), y.push_back(std::sin(3 * k)), z.push_back(k < 19 ? 1 : NAN);
  CHECK(std::isnan(modes_of(frame, x, y, z)[0]));
  z[19] = 1;
  CHECK(modes_of(frame, x, y, z)[0] == doctest::Approx(1));
}

TEST_CASE("a scan that cannot be read is refused with place and reason") {
  const calx_test::Scratch scratch;
  const auto with = [&](const std::string& csv, const std::string& observable = "", const std::string& measured = "") {
    return refusal(
        [&] { measured.empty() ? study_of(scratch, csv, observable) : study_of(scratch, csv, observable, measured); });
  };
  CHECK(says(with(scan(0.6, "x_mm,y_mm,height_cm,scan")),
             "/observables/0/measured/z: \"z_cm\" is no column of scan.csv"));
  CHECK(says(with(scan(0.6, "x_mm,y_mm,z,scan"), "",
                  R"("file": "scan.csv", "x": "x_mm", "y": "y_mm", "z": "z", "repeat": "scan")"),
             "/measured/z: column \"z\" of scan.csv ends in no unit; call it \"z_mm\" or \"z_m\""));
  CHECK(says(with(scan(0.6, "x_mm,y_kg,z_cm,scan"), "",
                  R"("file": "scan.csv", "x": "x_mm", "y": "y_kg", "z": "z_cm", "repeat": "scan")"),
             "/measured/y: column \"y_kg\" is in kg"));
  CHECK(says(with(scan(0.6) + "1,1,nan,1\n"), "column \"z_cm\" holds no finite number"));
  CHECK(says(with(scan(0.6), "", R"("file": "scan.csv", "x": "x_mm", "y": "y_mm", "z": "z_cm")"),
             "an sd cannot be estimated from 1 repeat"));
  CHECK(says(with(scan(0)), "all repeats are equal"));
  CHECK(says(with("x_mm,y_mm,z_cm,scan\n1,1,1,0\n2,2,1,0\n1,1,1,1\n2,3,1,1\n"),
             "repeat 0 of scan.csv holds 2 points; 12 or more"));
  CHECK(says(with(scan(0.6), R"("field": "heigth")"),
             "/observables/0/field: sensor \"surface\" has no field \"heigth\"; did you mean \"height\"?"));
  CHECK(says(with(scan(0.6), R"("field": "height", "column": "x")"), "/observables/0/column: stands beside \"field\""));
  CHECK(says(with(scan(0.6), R"("field": "height")", R"("value": 3, "sd": 1)"), "a map needs a \"file\""));
}

}  // namespace calx
