// calx plugin check, doctor and new as their callers see them: paths, messages, refusals, the page.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "conformance/conformance.hpp"
#include "plugin/scratch.hpp"
#include "report/shape_picture.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

template <class Call>
std::string fault_of(Call call) {
  try {
    call();
  } catch (const Error& e) {
    return std::to_string(e.exit_code()) + " " + e.what();
  }
  return "no error";
}

bool holds(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

std::string doctor(const std::string& path, bool expected_well = false) {
  bool well = false;
  const std::string text = plugin_doctor_text(path, well);
  CHECK(well == expected_well);
  return text;
}

}  // namespace

TEST_CASE("a path may be a manifest, a folder or a library; what is none of them is an error of files") {
  CheckOptions one;
  one.only = "loads";
  for (const std::string& path :
       {bad_folder("good"), bad_folder("good") + "/bad_good.plugin.json", bad_library("good")}) {
    const CheckReport report = check_plugins(path, one);
    REQUIRE(report.manifests.size() == 1);
    CHECK(report.count(CheckOutcome::passed) == 1);
    CHECK(report.manifests[0].results[0].name == "loads");
  }
  Scratch empty;
  CHECK(fault_of([&] { check_plugins(empty.path()); }) ==
        "6 " + empty.path() +
            ": holds no *.plugin.json; calx_add_plugin writes library and manifest into one folder, give that");
  CHECK(holds(fault_of([&] { check_plugins("/nowhere/at/all"); }), "6 /nowhere/at/all: No such file or directory"));
  one.only = "lods";
  CHECK(fault_of([&] { check_plugins(bad_folder("good"), one); }) ==
        "2 --only lods: no such check; did you mean \"loads\"?");
}

TEST_CASE("names of checks are kebab-case and stand once, each with a sentence") {
  std::string before;
  std::vector<std::string> seen;
  for (const auto& check : check_names()) {
    CAPTURE(check.first);
    CHECK(check.first.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos);
    CHECK(check.second.back() == '.');
    CHECK(std::find(seen.begin(), seen.end(), check.first) == seen.end());
    seen.push_back(check.first);
  }
  CHECK(seen.size() > 35);
}

TEST_CASE("the seed makes random checks repeatable, and fuzzing raises it") {
  CheckOptions options;
  options.only = "single-precision";
  options.seed = 7;
  const std::string once = check_json(check_plugins(bad_folder("good_law"), options));
  CHECK(once == check_json(check_plugins(bad_folder("good_law"), options)));
  CHECK(holds(once, "\"seed\": 7"));
  options.only = "";
  std::uint64_t rounds = 0;
  const CheckReport fuzzed = fuzz_plugins(bad_folder("asymmetric"), options, 1000, rounds);
  CHECK(fuzzed.count(CheckOutcome::failed) > 0);
  CHECK(holds(check_text(fuzzed, false), "seed " + std::to_string(7 + rounds)));
  options.only = "loads";
  CHECK(holds(fault_of([&] { fuzz_plugins(bad_folder("good_law"), options, 1, rounds); }), "draws nothing at random"));
}

TEST_CASE("in the process a failed check is told as well") {
  CheckOptions options;
  options.only = "force-blocks";
  options.in_process = true;
  const CheckReport report = check_plugins(bad_folder("replaces_forces"), options);
  CHECK(report.count(CheckOutcome::failed) == 1);
  // The eye rests at the end.
  const std::string text = check_text(report, true), last = "\nfailed: force-blocks of test.replaces-forces\n  ";
  CHECK(text.find(last) > text.find("FAILED  force-blocks"));
  CHECK(text.find(last) != std::string::npos);
}

TEST_CASE("the page holds every check, and the curves of a law") {
  Scratch scratch;
  CheckReport report = check_plugins(bad_folder("good_law"));
  write_check_page(report, scratch.path("check.html"));
  const std::string page = read_text(scratch.path("check.html"));
  for (const CheckResult& result : report.manifests.at(0).results) CHECK(holds(page, result.meaning));
  for (const char* chart : {"Force over overlap", "Restitution over speed", "Tangential loop"})
    CHECK(holds(page, chart));
  // The spring of 1e4 N/m: force over overlap is a line through the origin.
  bool seen = false;
  for (const CheckCurve& curve : report.manifests[0].curves) {
    if (curve.chart != "normal") continue;
    seen = true;
    REQUIRE(curve.x.size() > 700);
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      CHECK(std::abs(curve.y[k] - 1e4 * curve.x[k]) <= 1e-9 * curve.y[k]);
  }
  CHECK(seen);
  CHECK(report.manifests[0].shapes.empty());
  CHECK(holds(fault_of([&] { write_check_page(report, "/nowhere/check.html"); }), "6 /nowhere/check.html"));
}

TEST_CASE("the doctor says in plain words what is wrong and what helps") {
  struct Case {
    const char* plugin;
    const char* words;
  };
  for (const Case& one : {Case{"wrong_magic", "Begin calx_plugin_entry with CALX_ABI_MAGIC"},
                          {"other_major", "Compile it again against the headers of this installation"},
                          {"needs_host_symbols", "Link what it needs into it"},
                          {"changes_rounding", "Compile without -ffast-math"},
                          {"missing_symbol", "Define calx_plugin_entry with CALX_EXPORT"},
                          {"needs_extension", "Use a newer Calx"},
                          {"crashes_in_init", "gdb --args calx plugin check PATH --only loads --in-process"},
                          {"exits_in_create", "Return a negative status through host->fail instead"},
                          {"lying_manifest", "Manifest and library do not fit together"},
                          {"init_fails", "no calibration file"},
                          {"null_eval", "calx plugin check PATH names the row or function"}}) {
    CAPTURE(std::string(one.plugin));
    const std::string text = doctor(bad_folder(one.plugin));
    CAPTURE(text);
    CHECK(holds(text, one.words));
    CHECK(holds(text, "  refused: "));
    CHECK(holds(text, "  remedy: "));
  }
  CHECK(holds(doctor(bad_folder("good"), true), "Nothing is wrong with it"));
  // Misses nothing but what the user must give.
  CHECK(holds(doctor(bad_folder("create_rejects"), true), "Nothing is wrong with it"));

  Scratch scratch;
  CHECK(holds(doctor(scratch.path()), "There is no *.plugin.json in this folder"));
  fs::copy(bad_library("good"), scratch.path("x.so"));
  CHECK(holds(doctor(scratch.path("x.so")), "No manifest *.plugin.json beside it names this file"));
  scratch.write("x.plugin.json", manifest("test.good", "x.so"));
  fs::permissions(scratch.path("x.so"), fs::perms::others_write, fs::perm_options::add);
  CHECK(holds(doctor(scratch.path()), "chmod o-w on the file"));
}

TEST_CASE("a new plugin is refused for a name or kind that cannot be, and where something is there already") {
  Scratch scratch;
  CHECK(holds(fault_of([&] { new_plugin("Wet Hertz", "contact-law", scratch.path()); }),
              "2 plugin new Wet Hertz: a name is"));
  CHECK(holds(fault_of([&] { new_plugin("wet--hertz", "contact-law", scratch.path()); }), "2 "));
  CHECK(holds(fault_of([&] { new_plugin("../up", "contact-law", scratch.path()); }), "2 "));
  CHECK(fault_of([&] { new_plugin("wet", "contact-laws", scratch.path()); }) ==
        "2 --kind contact-laws: no such kind; did you mean \"contact-law\"?");
  CHECK(fault_of([&] { new_plugin("wet", "motion", scratch.path("no")); }) ==
        "6 " + scratch.path("no") + ": no such folder");
  scratch.write("wet/keep.txt", "mine");
  CHECK(holds(fault_of([&] { new_plugin("wet", "motion", scratch.path()); }), "is there already and is left as it is"));
  CHECK(read_text(scratch.path("wet/keep.txt")) == "mine");
}

TEST_CASE("the page holds the shapes of a geometry, each once, and the curves of a motion") {
  Scratch scratch;
  const CheckReport mesh = check_plugins(bad_folder("open_mesh"));
  const std::vector<CheckShape>& shapes = mesh.manifests.at(0).shapes;
  REQUIRE(shapes.size() == 2);
  CHECK(shapes[0].name == "test.open-mesh, presets");
  CHECK(shapes[0].triangles.size() == 3 * 10);  // a box without its lid
  CHECK(shapes[1].triangles.size() == 3 * 12);
  for (const double x : shapes[0].vertices) CHECK((x == 0 || x == doctest::Approx(0.1)));
  write_check_page(mesh, scratch.path("mesh.html"));
  const std::string page = read_text(scratch.path("mesh.html"));
  CHECK(holds(page, "<figcaption>test.open-mesh, presets: blue seen from outside"));
  CHECK(holds(page, "x, y, z: 100"));

  const CheckReport motion = check_plugins(bad_folder("wrong_velocity"));
  REQUIRE(motion.manifests.at(0).curves.size() == 1);  // it does not turn
  const CheckCurve& shift = motion.manifests[0].curves[0];
  CHECK(shift.chart == "shift");
  REQUIRE(shift.x.size() == shift.y.size());
  for (std::size_t k = 0; k < shift.x.size(); ++k) CHECK(std::abs(shift.y[k] - std::min(shift.x[k], 1.0)) < 1e-12);
  CHECK(shift.x.back() == doctest::Approx(1.2));
  write_check_page(motion, scratch.path("motion.html"));
  CHECK(holds(read_text(scratch.path("motion.html")), "Displacement over time"));
}

TEST_CASE("the page begins with what failed") {
  Scratch scratch;
  write_check_page(check_plugins(bad_folder("wrong_velocity")), scratch.path("check.html"));
  const std::string page = read_text(scratch.path("check.html"));
  const std::size_t first = page.find("velocity of test.wrong-velocity"), charts = page.find("class=\"charts\"");
  CHECK(holds(page, "<span class=\"status bad\">"));
  REQUIRE(first != std::string::npos);
  CHECK(first < charts);
}

TEST_CASE("a shape is drawn with nearer faces over farther ones, inside and outside apart") {
  // A square seen from outside, above, in front of one seen from inside, below.
  const std::vector<Vec3> vertices = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
                                      {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<std::uint32_t> up = {0, 1, 2, 0, 2, 3}, down = {4, 6, 5, 4, 7, 6};
  const auto fill = [](const std::string& svg, std::size_t from) {
    const std::size_t at = svg.find("fill=\"#", from);
    return at == std::string::npos ? std::string() : svg.substr(at + 7, 6);
  };
  const std::string above = fill(draw_shape(vertices, up), 0), below = fill(draw_shape(vertices, down), 0);
  CHECK(above != below);
  std::vector<std::uint32_t> both = up;
  both.insert(both.end(), down.begin(), down.end());
  const std::string svg = draw_shape(vertices, both);
  CHECK(fill(svg, 0) == below);
  CHECK(fill(svg, svg.rfind("<path")) == above);
  CHECK(draw_shape({}, {}).empty());
}
