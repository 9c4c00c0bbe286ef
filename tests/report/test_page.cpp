// The page as text: figures, absent files, a run still going, playback data.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "page_text.hpp"
#include "report/playback.hpp"
#include "report/report.hpp"
#include "report/section_picture.hpp"
#include "sample_run.hpp"
#include "scratch_folder.hpp"

using namespace calx;
using calx_test::charts_of;
using calx_test::has;
using calx_test::ScratchFolder;
using calx_test::slurp;

namespace {

std::vector<unsigned char> decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> out;
  std::uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((count += 6) >= 8) out.push_back(static_cast<unsigned char>(bits >> (count -= 8) & 255));
  }
  return out;
}

calx_test::SampleOptions small() {
  calx_test::SampleOptions options;
  options.grains = 300;
  options.frames_every = 4;
  return options;
}

}  // namespace

TEST_CASE("base64 as in RFC 4648") {
  const auto text = [](const std::string& s) {
    return base64(reinterpret_cast<const unsigned char*>(s.data()), s.size());
  };
  CHECK(text("") == "");
  CHECK(text("f") == "Zg==");
  CHECK(text("fo") == "Zm8=");
  CHECK(text("foobar") == "Zm9vYmFy");
}

TEST_CASE("a finished run gives its figures, charts, assumptions and provenance") {
  const ScratchFolder folder;
  calx_test::write_sample_run(folder.path(), small());
  const std::string path = write_report(folder.path());
  CHECK(path == folder.path() + "/report.html");
  const std::string page = slurp(path);
  CHECK(has(page, "<h1>Canister fill, standard operation</h1>"));
  CHECK(has(page, "2.1828\xc2\xa0kg"));
  CHECK(has(page, "0.159\xc2\xa0%"));
  CHECK(has(page, "Mass ledger closes."));
  CHECK(has(page, "Assumptions (4)"));
  CHECK(has(page, "rotor outer radius 25 mm"));
  CHECK(has(page, "Time step 6.05\xc2\xa0us is within the advised 6.05\xc2\xa0us."));
  CHECK(has(page, "<b>Rayleigh</b> <span class=\"tag\">binds</span>"));
  CHECK(has(page, "77aa10ce"));
  CHECK(has(page, "-13.2\xc2\xa0%"));
  CHECK(has(page, "left 3"));  // angle of repose
  CHECK_FALSE(has(page, "Not complete:"));

  const auto charts = charts_of(page);
  std::vector<std::string> titles;
  for (const auto& chart : charts) {
    titles.push_back(chart["title"]);
    if (chart["kind"] == "map") CHECK(chart["values"].size() == 1600);
    for (const auto& series : chart["series"]) CHECK(series["x"].size() == series["y"].size());
    CHECK_FALSE(chart["x"]["title"].get<std::string>().empty());
    CHECK_FALSE(chart["y"]["title"].get<std::string>().empty());
  }
  for (const char* title :
       {"canister mass against time", "Mass against cycle", "Mass per cycle", "nozzle flow: rate", "bed: section",
        "bed: azimuthal mean", "bed: height seen from above", "pile: angle of repose", "Energy ledger",
        "Energy remainder", "rotor load: torque", "contacts <all>: coordination", "residue: mass"}) {
    CAPTURE(title);
    CHECK(std::count(titles.begin(), titles.end(), title) == 1);
  }
  CHECK(charts[0]["marks"].size() == 3);
  CHECK(charts[0]["marks"][1]["name"] == "valve open");
}

TEST_CASE("a step above the advice is judged by what the run met, and is no failure") {
  const auto page = [](const std::string& status, const std::string& more) {
    const ScratchFolder folder;
    std::ofstream(folder.path() + "/summary.json") << R"({"title": "t", "status": ")" << status
                                                   << R"(", "time_step": 2e-5, "step_limits": [
             {"name": "rayleigh", "where": "10 % of 192 us", "seconds": 1.92e-5, "refused_above": 9.6e-5, "binds": false},
             {"name": "law", "where": "calcine-steel at an overlap of 0.0004 m", "seconds": 1.06e-5, "refused_above": 3.2e-5,
              "binds": true}])" << more << "}";
    std::string text = slurp(write_report(folder.path()));
    for (std::size_t at; (at = text.find("\xc2\xa0")) != std::string::npos;) text.replace(at, 2, " ");
    return text;
  };
  const std::string above =
      "<li class=\"open\"><b>Time step 20 us is given, above the advised 10.6 us.</b> Advice: law, calcine-steel at an "
      "overlap of 0.0004 m. A step above 32 us is refused.";
  const std::string plain = page("done", "");
  CHECK(has(plain, above + "</li>"));
  const std::string kept = page("done", R"(, "largest_overlap_share": 0.0312, "overlap_limit": 0.5,
    "law_limit_seen": {"where": "calcine-steel at an overlap of 3.9e-05 m", "seconds": 2.1e-5})");
  CHECK(has(kept, above +
                      " Largest overlap seen: 0.0312 of the radius (limit 0.5). At that overlap the law states a "
                      "stable step of 21 us (calcine-steel at an overlap of 3.9e-05 m), which the step keeps.</li>"));
  const std::string beyond = page("done", R"(, "largest_overlap_share": 0.889, "overlap_limit": 0.95,
    "law_limit_seen": {"where": "calcine-steel at an overlap of 0.0011 m", "seconds": 8.3e-6})");
  CHECK(has(beyond, above));
  CHECK(has(beyond,
            "stable step of 8.3 us (calcine-steel at an overlap of 0.0011 m): the step was above it for such a "
            "contact, so compare with a run at that step.</li>"));
  CHECK(has(beyond, "law, largest overlap of the run"));
  const std::string stopped = page("stopped", "");
  CHECK(has(stopped, "<li class=\"bad\"><b>Time step 20 us is given"));
  CHECK(has(stopped, "a smaller step is the first thing to try.</li>"));
}

TEST_CASE("the page refers to nothing outside itself and its data cannot become markup") {
  const ScratchFolder folder;
  calx_test::write_sample_run(folder.path(), small());
  const std::string page = slurp(write_report(folder.path()));
  CHECK(has(page, "default-src 'none'"));
  CHECK_FALSE(has(page, "<b>not markup</b>"));
  CHECK(has(page, "&lt;b&gt;not markup&lt;/b&gt;"));
  CHECK_FALSE(has(page, "@import"));
  CHECK_FALSE(has(page, "<link"));
  // Elements with an address: none may carry one but the menu's "#section".
  const std::regex address(
      "<(script|img|iframe|link|source|object|embed)[^>]{0,200}(src|href|data)\\s*=\\s*\"(?!data:|#)");
  std::size_t lines = 0;
  std::istringstream in(page);
  for (std::string line; std::getline(in, line); ++lines) {
    if (line.size() < 20000) CHECK_FALSE(std::regex_search(line, address));
  }
  CHECK(lines > 100);
}

TEST_CASE("an empty folder gives a page that says what is missing and why") {
  const ScratchFolder folder;
  const std::string page = slurp(write_report(folder.path()));
  for (const char* text : {"no summary yet", "summary.json is not there", "case.json is not there",
                           "No pictures: particles.h5", "No mass against time: the case has no sensor of kind mass",
                           "no sensor of kind cycle-mass", "No pile:", "No energy ledger:", "No mass ledger:",
                           "No loads on parts:", "No time-step limits:", "No provenance:", "No case:"}) {
    CAPTURE(text);
    CHECK(has(page, text));
  }
  CHECK(charts_of(page).empty());
}

TEST_CASE("a run that is still going shows how far it is") {
  const ScratchFolder folder;
  std::ofstream(folder.path() + "/summary.json")
      << R"({"title": "half way", "status": "running", "time": 1.5, "steps": 10, "sensors": {"level": {"kind": "mass"}}})";
  std::ofstream(folder.path() + "/case.json") << R"({"time": {"end": 6}})";
  std::filesystem::create_directories(folder.path() + "/series");
  std::ofstream(folder.path() + "/series/level.csv") << "time_s,mass_kg,particles_1\n0,0,0\n1,0.75,30\n1.5,1.";
  const std::string page = slurp(write_report(folder.path()));
  CHECK(has(page, "1.5 s of 6 s simulated"));
  CHECK(has(page, "width:25%"));
  CHECK(has(page, "0.75\xc2\xa0kg"));
  const auto charts = charts_of(page);
  CHECK(charts[0]["series"][0]["x"].size() == 2);
}

TEST_CASE("broken files become notes, a missing folder an error") {
  const ScratchFolder folder;
  std::ofstream(folder.path() + "/summary.json") << "{\"status\": \"run";
  std::ofstream(folder.path() + "/particles.h5") << "not HDF5";
  std::ofstream(folder.path() + "/fields.json")
      << R"({"fields": [{"sensor": "s", "name": "height", "nx": 2, "ny": 2, "cell": 1, "values": [1]}]})";
  const std::string page = slurp(write_report(folder.path()));
  CHECK(has(page, "summary.json is not valid JSON"));
  CHECK(has(page, "particles.h5 could not be read"));
  CHECK(has(page, "holds 1 values for 2 x 2 cells"));
  try {
    write_report(folder.path() + "/nowhere");
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::files);
    CHECK(has(e.what(), "nowhere is not a folder"));
  }
}

TEST_CASE("values of an unexpected type do no harm") {
  const ScratchFolder folder;
  std::ofstream(folder.path() + "/summary.json")
      << R"({"title": 7, "status": null, "time": "x", "mass": [1], "energy": "none", "sensors": [1, {"kind": 3}], "step_limits": 4,
             "provenance": {"plugins": ["calx.epam", {"id": "calx.stl", "version": 2}], "seed": {"a": 1}}, "assumptions": "one",
             "deviations": [null, {"figure": "dose", "value": 2, "reference": 0}], "events": {"a": {"name": "b", "time": 1}}})";
  std::ofstream(folder.path() + "/case.json") << R"({"gravity": "down", "time": 5, "assumptions": {"a": "b"}})";
  std::ofstream(folder.path() + "/fields.json") << R"({"fields": [3], "curves": [{"x": [1, null], "y": [2, "a"]}]})";
  const std::string page = slurp(write_report(folder.path()));
  CHECK(has(page, "<h1>7</h1>"));
  CHECK(has(page, "calx.stl"));
  CHECK(has(page, "Assumptions (1)"));
}

TEST_CASE("packed frames give positions, speeds and poses back") {
  const ScratchFolder folder;
  calx_test::write_sample_run(folder.path(), small());
  const RunFolder run = read_run_folder(folder.path());
  const Playback packed = pack_playback(run);
  CHECK(packed.note.empty());
  CHECK(packed.chosen.size() == run.frames.times.size());
  CHECK(packed.spheres == 750);
  const auto meta = nlohmann::json::parse(packed.json);
  CHECK(meta["spheres"] == 750);
  CHECK(meta["parts"].size() == 5);
  CHECK(meta["frames"].size() == packed.chosen.size());
  std::istringstream lines(packed.frames);
  std::string line;
  const std::size_t number = 3;
  for (std::size_t k = 0; k <= number; ++k) std::getline(lines, line);
  const auto bytes = decode(line);
  REQUIRE(bytes.size() == 8 * 750);
  const FrameData frame = read_frame(folder.path(), number);
  for (std::size_t i = 0; i < 750; i += 7) {
    const auto word = [&](std::size_t k) { return bytes[8 * i + 2 * k] + 256.0 * bytes[8 * i + 2 * k + 1]; };
    const float* axes[3] = {frame.x.data(), frame.y.data(), frame.z.data()};
    for (std::size_t k = 0; k < 3; ++k) {
      const double lo = meta["lo"][k], hi = meta["hi"][k];
      // Half a step of 16 bits, and the rounding of single precision.
      CHECK(std::fabs(lo + word(k) / 65535 * (hi - lo) - static_cast<double>(axes[k][i])) <=
            0.51 * (hi - lo) / 65535 + 1e-7);
    }
    const double share = (word(3) - 1) / 65534, speed = share * share * meta["highestSpeed"].get<double>();
    CHECK(speed == doctest::Approx(static_cast<double>(frame.speed[i])).epsilon(0.01));
  }
  const auto pose = meta["frames"][number]["poses"][3];
  CHECK(pose[1].get<double>() == doctest::Approx(frame.parts[3].turn.y));
  CHECK(pose[3].get<double>() == doctest::Approx(frame.parts[3].turn.w));
  CHECK(pose[6].get<double>() == doctest::Approx(0.515));
}

TEST_CASE("what does not fit is thinned out by whole particles and frames, and the page says so") {
  const ScratchFolder folder;
  calx_test::write_sample_run(folder.path(), small());
  PlaybackLimits limits;
  limits.spheres = 200;
  limits.frames = 3;
  limits.small_bytes = 0;
  const Playback packed = pack_playback(read_run_folder(folder.path()), limits);
  CHECK(packed.spheres == 188);  // every 4th of 375 clumps, both spheres
  CHECK(packed.chosen == std::vector<std::size_t>{0, 3, 5});
  CHECK(has(packed.note, "94 of 375 particles are drawn"));
  CHECK(has(packed.note, "3 of 6 recorded frames"));
  CHECK(spaced_frames(5, 40) == std::vector<std::size_t>{0, 1, 2, 3, 4});
  CHECK(spaced_frames(9, 1) == std::vector<std::size_t>{8});
}

TEST_CASE("the section shows spheres behind the plane and the cut of the parts") {
  FrameSet set;
  // A square plate 2 m x 2 m in the plane x = 0: cut by the plane y = 0 along the line from z = -1 to 1.
  set.parts.push_back({"plate", "calx.mesh", "steel", {0, -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1}, {0, 1, 2, 0, 2, 3}});
  FrameData frame;
  frame.parts.resize(1);
  for (float y : {-0.05f, 0.05f, 0.15f, 0.25f}) {
    frame.x.push_back(0.5f), frame.y.push_back(y), frame.z.push_back(0), frame.radius.push_back(0.1f),
        frame.speed.push_back(1);
    frame.particle.push_back(static_cast<std::uint32_t>(frame.particle.size()));
  }
  const SectionPicture picture = draw_section(set, frame, {0, 0, -9.81}, 1);
  CHECK(picture.spheres == 2);  // the one before the plane and the one too far behind are left out
  CHECK(has(picture.svg, speed_colour(1)));
  CHECK(has(picture.svg, "M14.0 "));
  CHECK(speed_colour(0) == "#748eb8");
  frame.parts[0].present = false;
  CHECK(draw_section(set, FrameData(), {0, 0, -9.81}, 1).svg.empty());
}
