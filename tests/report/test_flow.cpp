// Lab plots of flow and piles: drawn by kind of sensor from the files of a run, figures in their captions.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "report/report.hpp"
#include "scratch_folder.hpp"

using calx_test::ScratchFolder;
using nlohmann::json;

namespace {

struct Lab {
  json summary = {{"title", "lab"}, {"status", "done"}, {"sensors", json::object()}};
  json curves = json::array();
  std::vector<std::pair<std::string, std::string>> series;

  void sensor(const std::string& name, const std::string& kind, const std::string& columns, const std::string& row) {
    summary["sensors"][name] = {{"kind", kind}, {"every", 0.1}, {"last", json::object()}};
    series.emplace_back(name, "time_s," + columns + "\n0.5," + row + "\n");
  }
  void curve(const std::string& sensor, const std::string& name, const std::string& x_name, const std::string& y_name,
             const std::vector<double>& x, const std::vector<double>& y) {
    curves.push_back({{"sensor", sensor}, {"name", name}, {"x_name", x_name}, {"y_name", y_name}, {"x", x}, {"y", y}});
  }
  /// The page of a folder with these files, no-break spaces as blanks.
  std::string page() const {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.path() + "/series");
    std::ofstream(folder.path() + "/summary.json") << summary;
    std::ofstream(folder.path() + "/fields.json") << json{{"fields", json::array()}, {"curves", curves}};
    for (const auto& [name, text] : series) std::ofstream(folder.path() + "/series/" + name + ".csv") << text;
    std::ostringstream all;
    all << std::ifstream(calx::write_report(folder.path())).rdbuf();
    std::string text = all.str();
    for (std::size_t at; (at = text.find("\xc2\xa0")) != std::string::npos;) text.replace(at, 2, " ");
    return text;
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

json chart_called(const std::string& page, const std::string& title) {
  const std::string open = "id=\"charts\">";
  const std::size_t from = page.find(open) + open.size();
  for (const json& chart : json::parse(page.substr(from, page.find("</script>", from) - from)))
    if (chart["title"] == title) return chart;
  return {};
}

}  // namespace

TEST_CASE("a discharge has its mass, its fitted middle and Beverloo's line, and says all figures") {
  Lab lab;
  lab.sensor("out", "discharge",
             "mass_kg,retained_kg,rate_kg_s,rate_sd_kg_s,r2_1,pause_s,density_kg_m3,grain_m,beverloo_kg_s,ratio_1",
             "0.08,0.015,0.0602,0.0024,0.9998,0.02,1210,0.00277,0.0815,0.739");
  lab.curve("out", "discharge", "time_s", "mass_kg", {0, 1, 2}, {0, 0.06, 0.08});
  lab.curve("out", "middle half", "time_s", "mass_kg", {0.4, 1}, {0.02, 0.06});
  lab.curve("out", "Beverloo", "time_s", "mass_kg", {0.4, 1}, {0.01, 0.07});
  const std::string page = lab.page();
  const json chart = chart_called(page, "out: mass discharged against time");
  REQUIRE(chart["series"].size() == 3);
  CHECK(chart["series"][1]["y"] == json({20, 60}));
  CHECK(chart["series"][2]["name"] == "Beverloo, same grains");
  CHECK(has(page, "80 g discharged, 15 g retained. Rate 60.2 g/s \xc2\xb1 2.4 g/s"));
  CHECK(has(page, "longest pause 20 ms"));
  CHECK(has(page, "for grains of 2.77 mm at a bulk density of 1210 kg/m^3: 81.5 g/s, ratio 0.739."));
  CHECK(has(page, "href=\"#flow\""));
  // A rig has no dosing, pile or loads, and says nothing of them.
  for (const char* empty : {"No mass against time", "No masses per cycle", "No pile", "No loads", "href=\"#dosing\""})
    CHECK_FALSE(has(page, empty));
}

TEST_CASE("a pile has its profile, flank and sectors; the angle of the last row counts, not an older one") {
  Lab lab;
  const std::string columns = "angle_deg,sd_deg,sectors_1,bins_1,volume_angle_deg";
  lab.sensor("cone", "angle-of-repose", columns, "39.2,1.14,12,96,38.1");
  lab.curve("cone", "profile", "radius_m", "height_m", {0.001, 0.05}, {0.04, 0.002});
  lab.curve("cone", "flank", "radius_m", "height_m", {0.01, 0.04}, {0.03, 0.01});
  lab.curve("cone", "sectors", "azimuth_deg", "angle_deg", {-150, 30}, {38, 40.4});
  lab.sensor("low", "angle-of-repose", columns, "30,1,12,96,29\n0.6,,,3,12,");
  lab.curve("low", "profile", "distance_m", "height_m", {-0.05, 0.05}, {-0.1, -0.12});
  lab.sensor("flat", "angle-of-repose", columns, "0.6,,,3,12,");
  lab.summary["sensors"]["flat"]["reason"] = "the pile rises 3 grain diameters";
  lab.curve("flat", "profile", "radius_m", "height_m", {0.001, 0.05}, {0.01, 0.009});
  const std::string page = lab.page();
  CHECK(has(page,
            "Angle of repose 39.2 \xc2\xb1 1.1\xc2\xb0 over 12 sectors and 96 bins. Independent of any fit, from "
            "volume and base: 38.1\xc2\xb0."));
  const json profile = chart_called(page, "cone: profile and fitted flank");
  CHECK(profile["equal"] == true);
  CHECK(profile["series"][0]["style"] == "area");
  CHECK(profile["series"][1]["name"] == "flank");
  const json sectors = chart_called(page, "cone: angle of each sector");
  CHECK(sectors["bands"][0]["mean"] == 39.2);
  CHECK(sectors["series"][0]["x"] == json({-150, 30}));
  // A pile below 0 is a line, for an area would reach up to 0.
  CHECK(chart_called(page, "low: profile and fitted flank")["series"][0]["style"] == "line");
  CHECK(has(page, "No flank was found that gives an angle."));
  CHECK(has(page, "No angle: the pile rises 3 grain diameters."));
  // Its curves are not drawn a second time under Pile.
  CHECK(chart_called(page, "cone: sectors").is_null());
  CHECK(chart_called(page, "cone: profile").is_null());
}

TEST_CASE("a drum has its surface between wall and lines; an inertial number is judged") {
  Lab lab;
  lab.sensor("bed", "drum-surface", "angle_deg,far_deg,rms_m,far_rms_m,level_m,fill_1,frames_1",
             "40.8,39.4,0.00035,0.00105,-0.0002,0.515,60");
  lab.curve("bed", "surface", "u_m", "height_m", {-0.03, 0.03}, {0.025, -0.025});
  lab.curve("bed", "near line", "u_m", "height_m", {-0.012, 0.012}, {0.01, -0.01});
  lab.curve("bed", "far line", "u_m", "height_m", {-0.025, 0.025}, {0.02, -0.02});
  lab.curve("bed", "drum", "u_m", "height_m", {0.042, -0.042, 0.042}, {0, 0, 0});
  for (const auto& [name, value] :
       {std::pair<const char*, const char*>{"slow", "0.0004"}, {"fast", "0.03"}, {"wild", "0.4"}})
    lab.sensor(name, "inertial-number", "inertial_1,largest_1", std::string("0,") + value);
  const std::string page = lab.page();
  const json chart = chart_called(page, "bed: free surface in the drum");
  CHECK(chart["equal"] == true);
  CHECK(chart["series"].size() == 4);
  CHECK(has(page, "Dynamic angle 40.8\xc2\xb0 near the middle (rms 350 um), 39.4\xc2\xb0 over the wider part"));
  CHECK(has(page, "Where half of 60 frames show grains; dark share 51.5 %."));
  CHECK(has(page, "largest inertial number 0.0004, quasi-static (below 0.001)."));
  CHECK(has(page, "largest inertial number 0.03, not quasi-static (above 0.001)"));
  CHECK(has(page, "largest inertial number 0.4, collisional (above 0.1)."));
}

TEST_CASE("without such sensors there is no section, and one without rows says so") {
  Lab lab;
  CHECK_FALSE(has(lab.page(), "id=\"flow\""));
  lab.sensor("cone", "angle-of-repose", "angle_deg", "");
  CHECK(has(lab.page(), "Sensor cone: no pile was seen yet."));
}
