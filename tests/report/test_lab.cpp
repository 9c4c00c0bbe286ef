// Laboratory plots from hand-written series: what is drawn, and the figures in the captions.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "page_text.hpp"
#include "report/report.hpp"
#include "scratch_folder.hpp"

using namespace calx;
using calx_test::has;
using calx_test::ScratchFolder;
using calx_test::slurp;

namespace {

using Json = nlohmann::json;

struct Page {
  std::string html;
  Json charts;
  /// The chart whose title ends so.
  const Json& chart(const std::string& ending) const {
    for (const Json& c : charts) {
      const std::string title = c["title"];
      if (title.size() >= ending.size() && title.substr(title.size() - ending.size()) == ending) return c;
    }
    FAIL("no chart " << ending);
    return charts;
  }
  static const Json& series(const Json& chart, const std::string& name) {
    for (const Json& s : chart["series"])
      if (s["name"] == name) return s;
    FAIL("no series " << name);
    return chart;
  }
};

/// The report of a run with one sensor.
Page page_of(const std::string& kind, const std::string& csv) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() + "/series");
  std::ofstream(folder.path() + "/series/test.csv") << csv;
  std::ofstream(folder.path() + "/summary.json")
      << Json{{"title", "rig"},
              {"status", "done"},
              {"sensors", {{"test", {{"kind", kind}, {"every", 1}, {"last", Json::object()}}}}}};
  Page page;
  page.html = slurp(write_report(folder.path()));
  const std::string open = "id=\"charts\">";
  const std::size_t from = page.html.find(open) + open.size();
  page.charts = Json::parse(page.html.substr(from, page.html.find("</script>", from) - from));
  return page;
}

}  // namespace

TEST_CASE("compression: density and CPS against log stress, up and down, repeated rows once") {
  const Page page = page_of("cell-density",
                            "time_s,step_1,stress_Pa,height_m,volume_m3,density_kg_m3,solid_fraction_1,cps_percent,"
                            "drift_1,speed_m_s,inertial_1\n"
                            "0,0,nan,nan,nan,nan,nan,nan,nan,nan,nan\n"
                            "1,1,500,0.03,1,1200,0.6,0,0.0001,0,0.0001\n"
                            "1.5,1,500,0.03,1,1200,0.6,0,0.0001,0,0.0001\n"
                            "2,2,5000,0.03,1,1220,0.6,2,0.0001,0,0.0002\n"
                            "3,3,15000,0.03,1,1250,0.6,4,0.0001,0,0.0003\n"
                            "4,4,1000,0.03,1,1230,0.6,3,0.0001,0,0.0001\n");
  CHECK(has(page.html, "id=\"lab\""));
  const Json& density = page.chart("bulk density against stress");
  CHECK(density["x"]["log"] == true);
  CHECK(Page::series(density, "loading")["x"] == Json{0.5, 5, 15});
  CHECK(Page::series(density, "loading")["y"] == Json{1200, 1220, 1250});
  CHECK(Page::series(density, "unloading")["x"] == Json{1, 15});
  CHECK(Page::series(page.chart("compressibility (CPS) against stress"), "loading")["y"] == Json{0, 2, 4});
  CHECK(has(page.html, "4\xc2\xa0% at 15\xc2\xa0kPa, of which 25\xc2\xa0% come back on unloading to 1000\xc2\xa0Pa"));
  CHECK(has(page.html, "Largest inertial number 0.0003, below the limit of 0.001"));
}

TEST_CASE("taps: density against their number, Hausner ratio") {
  const Page page = page_of("cell-density",
                            "time_s,step_1,stress_Pa,height_m,volume_m3,density_kg_m3,inertial_1\n"
                            "0,0,nan,nan,nan,nan,nan\n1,1,nan,0.05,1,1000,nan\n2,2,nan,0.04,1,1250,nan\n");
  CHECK(Page::series(page.chart("bulk density against taps"), "bulk density")["y"] == Json{1000, 1250});
  CHECK(has(page.html, "Hausner ratio 1.25, Carr index 20\xc2\xa0%"));
}

TEST_CASE(
    "wall friction: points, those not steady apart, the line and its errors, a warning above the inertial limit") {
  const Page page =
      page_of("wall-friction",
              "time_s,step_1,normal_Pa,shear_Pa,ratio_1,angle_deg,drift_1,steady_1,inertial_1,phi_w_deg,phi_w_se_deg,"
              "adhesion_Pa,"
              "adhesion_se_Pa\n"
              "1,2,8000,3300,0.4,22,0.01,1,0.0001,nan,nan,nan,nan\n2,3,4000,3000,0.75,37,0.4,0,0.002,nan,nan,nan,nan\n"
              "3,4,2000,900,0.45,24,0.01,1,0.0004,21.8014,0.25,100,12\n");
  const Json& chart = page.chart("wall yield locus");
  CHECK(chart["equal"] == true);
  CHECK(Page::series(chart, "steady")["x"] == Json{8, 2});
  CHECK(Page::series(chart, "not steady, not in the line")["y"] == Json{3});
  const Json& line = Page::series(chart, "wall yield locus");
  CHECK(line["y"][0].get<double>() == doctest::Approx(0.1));
  CHECK(line["y"][1].get<double>() == doctest::Approx(0.1 + 0.4 * 8.4).epsilon(1e-4));
  CHECK(
      has(page.html, "Angle of wall friction 21.8 \xc2\xb1 0.25\xc2\xa0\xc2\xb0, adhesion 100 \xc2\xb1 12\xc2\xa0Pa"));
  CHECK(has(page.html, "<b>above</b> the limit of 0.001"));
  CHECK(has(page.html, "<b>1 of 3 steps had not become steady.</b>"));
}

TEST_CASE("shear: yield locus with its circles for each level, and the flow function") {
  const std::string tail = ",30,0.5,1000,40,3464.1016,9866.0254,2133.9746,2.848,40.12,28.1\n";
  const Page page = page_of(
      "yield-locus",
      "time_s,step_1,role_1,level_1,normal_Pa,shear_Pa,prorated_Pa,drift_1,steady_1,inertial_1,phi_deg,phi_se_deg,"
      "cohesion_Pa,cohesion_se_Pa,strength_Pa,sigma1_Pa,sigma3_Pa,ffc_1,effective_deg,steady_deg\n"
      "1,1,1,1,7000,3734,nan,0.01,1,0.0001,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n"
      "2,2,0,1,7000,0,nan,0.01,1,0.0001,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n"
      "3,3,2,1,4000,3309,3300,0.01,1,0.0001" +
          tail + "4,4,1,1,7000,3700,nan,0.2,0,0.0001" + tail);
  const Json& chart = page.chart("yield locus");
  CHECK(Page::series(chart, "pre-shear")["y"] == Json{3.734, 3.7});
  CHECK(Page::series(chart, "shear to failure, prorated")["y"] == Json{3.3});
  const Json& steady = Page::series(chart, "steady flow");
  const std::size_t top = steady["x"].size() / 2;
  CHECK(steady["x"][0].get<double>() == doctest::Approx(2.1339746));
  CHECK(steady["x"][top].get<double>() == doctest::Approx(6));
  CHECK(steady["y"][top].get<double>() == doctest::Approx(3.8660254));
  CHECK(Page::series(chart, "unconfined yield")["x"].back().get<double>() == doctest::Approx(3.4641016));
  CHECK(has(page.html, "Internal friction 30 \xc2\xb1 0.5\xc2\xa0\xc2\xb0, cohesion 1000 \xc2\xb1 40\xc2\xa0Pa"));
  CHECK(has(page.html, "<b>1 of 2 pre-shears had not become steady.</b>"));
  const Json& function = page.chart("flow function");
  CHECK(Page::series(function, "flow function")["x"][0].get<double>() == doctest::Approx(9.8660254));
  CHECK(Page::series(function, "ff_c = 4")["y"][1].get<double>() == doctest::Approx(1.2 * 9.8660254 / 4));
}

TEST_CASE("without such a sensor there is no section, without a step a sentence") {
  CHECK_FALSE(has(page_of("mass", "time_s,mass_kg\n0,1\n").html, "id=\"lab\""));
  CHECK(has(page_of("yield-locus", "time_s,step_1\n0,0\n").html, "no step of its motion has ended yet"));
}
