#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "io/scratch.hpp"
#include "study/observe.hpp"

namespace calx {
namespace {

StudyObservable asks(const std::string& column, const std::string& against, std::vector<double> x, double factor = 1) {
  StudyObservable o;
  o.sensor = "rig";
  o.column = column;
  o.against = against;
  o.factor = factor;
  o.measured.x = std::move(x);
  return o;
}

struct Folder : calx_test::Scratch {
  Folder() {
    std::filesystem::create_directories(path + "/series");
    std::ofstream(path + "/summary.json") << R"({"sensors": {"rig": {"last": {"mass_kg": 0.25, "angle_deg": null}}}})";
    std::ofstream(path + "/series/rig.csv") << "time_s,mass_kg,stress_Pa\n0,0,100\n1,2,300\n1.99999,3,200\n";
    std::ofstream(path + "/fields.json")
        << R"({"curves": [{"sensor": "rig", "x_name": "radius_m", "y_name": "height_m", "x": [0, 0.1], "y": [1, 0.5]}]})";
  }
};

}  // namespace

TEST_CASE("a last value is converted to the unit that was measured") {
  const Folder run;
  CHECK(observe(run.path, asks("mass_kg", "", {}, 1000)) == std::vector<double>{250});
}

TEST_CASE("a figure that the run does not have is not a number") {
  const Folder run;
  CHECK(std::isnan(observe(run.path, asks("angle_deg", "", {}))[0]));
  CHECK(std::isnan(observe(run.path, asks("speed_m_s", "", {}))[0]));
}

TEST_CASE("a curve is interpolated, and held for half a sample beyond its end") {
  const Folder run;
  const std::vector<double> y = observe(run.path, asks("mass_kg", "time_s", {0.25, 1, 1.5, 2, 2.6}, 1000));
  CHECK(y[0] == doctest::Approx(500));
  CHECK(y[1] == 2000);
  CHECK(y[2] == doctest::Approx(2500).epsilon(1e-4));
  CHECK(y[3] == 3000);
  CHECK(std::isnan(y[4]));
}

TEST_CASE("against a column that turns back, the first passage counts") {
  const Folder run;
  // The stress passes 250 Pa at 0.75 s on its way up, and once more on its way down.
  CHECK(observe(run.path, asks("mass_kg", "stress_Pa", {250}))[0] == doctest::Approx(1.5));
}

TEST_CASE("curves of fields.json can be asked for, what is nowhere cannot") {
  const Folder run;
  CHECK(observe(run.path, asks("height_m", "radius_m", {0.05}))[0] == doctest::Approx(0.75));
  CHECK_THROWS_AS(observe(run.path, asks("depth_m", "radius_m", {0.05})), Error);
  CHECK_THROWS_AS(observe(run.path + "/none", asks("mass_kg", "", {})), Error);
}

}  // namespace calx
