// The rows of a publication: what a rows file may say, where figures lie against references, and the page.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "config/config.hpp"
#include "report/paper.hpp"
#include "report/paper_figures.hpp"
#include "report/paper_words.hpp"
#include "scratch_folder.hpp"

using namespace calx;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t all_seeds = std::numeric_limits<std::size_t>::max();

void write(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path) << text;
}

std::string read(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

const char* const case_text = R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1}})";

/// A rows file of one run with two forms; rows: the text of the list.
std::string rows_text(const std::string& rows, const std::string& seeds = "[1, 2, 3]") {
  return R"({"calx_paper": 1, "title": "Rows", "source": "a paper", "runs": {
    "overfill": {"seeds": )" +
         seeds + R"(, "full": {"case": "case.json"},
      "reduced": {"case": "case.json", "set": {"/time/end": 0.5}, "reduced": ["half the time"]}},
    "other": {"seeds": [1, 2], "reduced": {"case": "case.json", "set": {"/time/end": 0.25}, "reduced": ["a quarter"]}}},
  "rows": [)" +
         rows + "]}";
}

const char* const residue_row = R"({"name": "Residue", "group": "Overfill", "unit": "g",
  "measured": {"value": 6, "where": "Results"}, "simulated": {"value": 5.23056, "where": "Results"},
  "claims": [{"words": "overestimation", "where": "Conclusion", "sign": "above"}],
  "calx": {"run": "overfill", "sensor": "residue", "column": "mass_kg"},
  "plots": [{"title": "Residue", "since": "half", "sensor": "residue", "x": "time_s", "y": "mass_kg"}],
  "assumed": ["a recess of 6 mm"]})";

struct Files {
  calx_test::ScratchFolder folder;
  std::string rows = folder.path() + "/rows.json", out = folder.path() + "/out";
  explicit Files(const std::string& text) {
    write(folder.path() + "/case.json", case_text);
    write(rows, text);
  }
  PaperRows paper() const { return read_paper_rows(rows); }
  /// A finished run whose residue rises from 0 to the mass given, with an event in the middle.
  void finish(const std::string& run, std::uint64_t seed, double mass, const std::string& status = "done") const {
    const PaperRows rows_read = paper();
    const PaperRun& of = paper_run(rows_read, run);
    const std::string dir = paper_run_folder(out, of, paper_reduced, seed);
    const PaperForm& form = of.forms[paper_reduced];
    write(dir + "/case.json", read_case(form.case_path, paper_overrides(form, seed)).resolved);
    write(dir + "/summary.json",
          R"({"title": "t", "status": ")" + status +
              R"(", "time": 0.5, "sensors": {"residue": {"kind": "mass", "every": 0.25, "columns": ["mass_kg"]}},
                 "events": [{"name": "half", "time": 0.25}], "assumptions": ["of the case"]})");
    std::ostringstream series;
    series.precision(12);
    series << "time_s,mass_kg\n0,0\n0.25," << mass / 4 << "\n0.5," << mass << "\n";
    write(dir + "/series/residue.csv", series.str());
  }
};

std::string message_of(const std::string& text) {
  const Files files(text);
  try {
    files.paper();
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
    const std::string what = e.what();
    return what.substr(what.find("rows.json"));
  }
  return "read without an error";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

PaperReference number(double low, double high) {
  PaperReference r;
  r.kind = low < high ? PaperReference::Kind::range : PaperReference::Kind::value;
  r.low = low, r.high = high;
  return r;
}

}  // namespace

TEST_CASE("5.23 g against 6 g is an underestimate, whatever the words say") {
  const PaperDifference d = difference_to(5.23056, 5.23056, number(6, 6));
  CHECK(d.sign == -1);
  CHECK(d.amount == doctest::Approx(-0.76944));
  CHECK(d.share == doctest::Approx(-0.12824));
  CHECK(difference_html(d, number(6, 6), "g") == "underestimate, -0.769\xc2\xa0g (-12.8\xc2\xa0%)");
  CHECK(difference_to(6.1, 6.1, number(6, 6)).sign == 1);
  CHECK(difference_to(1.21, 1.21, number(1.21, 1.21)).sign == 0);
}

TEST_CASE("a range is missed from its nearest end, and met inside or by overlap") {
  const PaperReference measured = number(38, 42);
  CHECK(difference_to(40, 41, measured).sign == 0);
  CHECK(difference_to(30, 30, measured).amount == doctest::Approx(-8));
  CHECK(difference_to(43, 43, measured).amount == doctest::Approx(1));
  CHECK(difference_to(43, 43, measured).share == doctest::Approx(1.0 / 42));
  CHECK(difference_to(41, 45, measured).sign == 0);
  CHECK(side_html(difference_to(40, 41, measured), measured) == "in the range");
  CHECK_FALSE(difference_to(1, 1, PaperReference{}).known);
}

TEST_CASE("a sign is met by the same side of zero") {
  PaperReference left;
  left.kind = PaperReference::Kind::sign;
  left.sign = -1;
  CHECK(side_html(difference_to(-3, -3, left), left) == "same side");
  CHECK(side_html(difference_to(3, 3, left), left) == "other side");
}

TEST_CASE("figures come from finished runs, with the scatter of seeds") {
  const Files files(rows_text(residue_row));
  files.finish("overfill", 1, 0.005);
  files.finish("overfill", 2, 0.006);
  const PaperRows rows = files.paper();
  const PaperResult r = paper_result(rows, rows.rows[0], paper_reduced, all_seeds, files.out);
  REQUIRE(r.spread.count == 2);
  CHECK(r.spread.mean == doctest::Approx(5.5));  // kg to g
  CHECK(r.spread.deviation == doctest::Approx(std::sqrt(0.5)));
  CHECK(result_html(r, "g") ==
        "5.50 \xc2\xb1 0.71\xc2\xa0g <small>(n\xc2\xa0=\xc2\xa0"
        "2)</small>");
  REQUIRE(r.missing.size() == 1);
  CHECK(r.missing[0] == "Run \"overfill\": not run yet with seed 3");
  CHECK(paper_result(rows, rows.rows[0], paper_reduced, 1, files.out).spread.count == 1);
  CHECK(paper_result(rows, rows.rows[0], paper_full, all_seeds, files.out).spread.count == 0);
}

TEST_CASE("a run counts only when it is finished and its case is the one of the rows") {
  const Files files(rows_text(residue_row));
  files.finish("overfill", 1, 0.005, "interrupted");
  files.finish("overfill", 2, 0.006);
  const PaperRows rows = files.paper();
  const PaperForm& form = rows.runs[0].forms[paper_reduced];
  const auto state = [&](std::uint64_t seed) {
    return paper_run_state(paper_run_folder(files.out, rows.runs[0], paper_reduced, seed), form, seed);
  };
  CHECK(state(1) == PaperRunState::unfinished);
  CHECK(state(2) == PaperRunState::done);
  CHECK(state(3) == PaperRunState::missing);
  // Words do not change numbers; the gravity does.
  write(files.folder.path() + "/case.json", replaced(case_text, "\"calx\": 1", "\"calx\": 1, \"title\": \"new\""));
  CHECK(state(2) == PaperRunState::done);
  write(files.folder.path() + "/case.json",
        replaced(case_text, "\"calx\": 1", "\"calx\": 1, \"gravity\": [0, 0, -1.6]"));
  CHECK(state(2) == PaperRunState::outdated);
}

TEST_CASE("terms add up, at events and since events") {
  const Files files(rows_text(replaced(residue_row, R"("sensor": "residue", "column": "mass_kg"})",
                                       R"("sum": [{"sensor": "residue", "column": "mass_kg", "since": "half"},
                              {"sensor": "residue", "column": "mass_kg", "at": "half", "factor": -2}]})")));
  files.finish("overfill", 1, 0.008);
  const PaperRows rows = files.paper();
  // (8 - 2) g - 2 * 2 g
  CHECK(paper_result(rows, rows.rows[0], paper_reduced, 1, files.out).spread.mean == doctest::Approx(2));
}

TEST_CASE("a difference of runs is judged against the scatter of seeds") {
  const Files files(
      rows_text(replaced(replaced(residue_row, R"("run": "overfill")", R"("run": "overfill", "minus": "other")"),
                         R"("assumed")", R"("against_scatter": true, "assumed")")));
  for (const auto& [run, shift] : {std::pair<const char*, double>{"overfill", 0}, {"other", 0.0004}}) {
    files.finish(run, 1, 0.005 + shift);
    files.finish(run, 2, 0.006 + shift);
  }
  const PaperRows rows = files.paper();
  const PaperResult r = paper_result(rows, rows.rows[0], paper_reduced, all_seeds, files.out);
  CHECK(r.spread.mean == doctest::Approx(-0.4));
  CHECK(r.pooled == doctest::Approx(std::sqrt(0.5)));
  CHECK(r.spread.deviation == doctest::Approx(std::sqrt(0.5)));  // sd sqrt(1/2 + 1/2)
  CHECK(read(write_paper(rows, all_seeds, files.out)).find("The difference is no larger than between seeds.") !=
        std::string::npos);
  files.finish("other", 1, 0.009);
  files.finish("other", 2, 0.0095);
  CHECK(read(write_paper(rows, all_seeds, files.out)).find("The difference exceeds that between seeds.") !=
        std::string::npos);
}

TEST_CASE("the page shows figures, contradictions, assumptions and what was not run") {
  const Files files(rows_text(std::string(residue_row) + "," +
                              replaced(residue_row, "\"name\": \"Residue\"", "\"name\": \"Residue again\"")));
  const PaperRows rows = files.paper();
  const std::string empty = read(write_paper(rows, all_seeds, files.out));
  CHECK(empty.find("not run yet with seed 1, 2, 3") != std::string::npos);
  CHECK(empty.find("<i>not run</i>") != std::string::npos);
  CHECK(empty.find("its text says overestimate") != std::string::npos);
  files.finish("overfill", 1, 0.0055);
  const std::string page = read(write_paper(rows, all_seeds, files.out));
  CHECK(page.find("5.5\xc2\xa0g") != std::string::npos);
  CHECK(page.find("underestimate, -0.5\xc2\xa0g (-8.33\xc2\xa0%)") != std::string::npos);
  CHECK(page.find("The publication contradicts itself.") != std::string::npos);
  CHECK(page.find("says overestimate; its numbers say underestimate, -0.769") != std::string::npos);
  CHECK(page.find("a recess of 6 mm") != std::string::npos);
  CHECK(page.find("half the time") != std::string::npos);
  CHECK(page.find("of the case") != std::string::npos);
  CHECK(page.find("Set for this row, in place of what the case says, reduced (1)") != std::string::npos);
  CHECK(page.find("/time/end = 0.5") != std::string::npos);
  CHECK(page.find("href=\"runs/overfill/reduced/seed-1/report.html\"") != std::string::npos);
  CHECK(page.find("default-src 'none'") != std::string::npos);
  // Rows of the plot from the event on, s as ms and kg as g.
  CHECK(page.find("\"x\":[250,500],\"y\":[1.375,5.5]") != std::string::npos);
}

TEST_CASE("a claim that its numbers bear out is no contradiction") {
  const Files files(rows_text(replaced(residue_row, "\"sign\": \"above\"", "\"sign\": \"below\"")));
  const std::string page = read(write_paper(files.paper(), all_seeds, files.out));
  CHECK(page.find("contradicts") == std::string::npos);
  CHECK(page.find("The publication's words agree with its numbers:") != std::string::npos);
}

TEST_CASE("a figure that a run cannot give is named on the page") {
  const auto page = [](const std::string& from, const std::string& to) {
    const Files files(rows_text(replaced(residue_row, from, to)));
    files.finish("overfill", 1, 0.005);
    return read(write_paper(files.paper(), all_seeds, files.out));
  };
  const std::string figure = R"("sensor": "residue", "column": "mass_kg"})";
  CHECK(page(figure, R"("sensor": "residu", "column": "mass_kg"})").find("did you mean &quot;residue&quot;?") !=
        std::string::npos);
  CHECK(page(figure, R"("sensor": "residue", "column": "mass_g"})").find("has no column &quot;mass_g&quot;") !=
        std::string::npos);
  CHECK(page(figure, R"("sensor": "residue", "column": "mass_kg", "at": "halve"})")
            .find("event &quot;halve&quot; did not happen") != std::string::npos);
  CHECK(page("\"unit\": \"g\"", "\"unit\": \"deg\"").find("the row's unit is deg") != std::string::npos);
}

TEST_CASE("bad rows files are refused with place and remedy") {
  const std::string good = rows_text(residue_row);
  CHECK(message_of(replaced(good, "\"calx_paper\": 1", "\"calx_paper\": 2")) ==
        "rows.json /calx_paper: 2 is not known; this calx reads 1");
  CHECK(message_of(rows_text("")) == "rows.json /rows: is an empty list; must hold at least one row");
  CHECK(message_of(replaced(good, "\"run\": \"overfill\"", "\"run\": \"overfil\"")) ==
        "rows.json /rows/0/calx/run: no run is called \"overfil\"; did you mean \"overfill\"?");
  CHECK(message_of(replaced(good, "\"value\": 6", "\"value\": 6, \"range\": [1, 2]")) ==
        "rows.json /rows/0/measured: must hold one of \"value\", \"range\", \"sign\" and \"words\"");
  CHECK(message_of(replaced(good, "\"value\": 6", "\"range\": [42, 38]")) ==
        "rows.json /rows/0/measured/range: 42 is not below 38; the lower one must be first");
  CHECK(message_of(replaced(good, "\"unit\": \"g\"", "\"unit\": \"gg\"")).find("rows.json /rows/0/unit: ") == 0);
  CHECK(message_of(replaced(good, "\"unit\": \"g\",", "")) ==
        "rows.json /rows/0/unit: is missing; the unit of the figures, such as \"g\"; \"1\" for none");
  CHECK(message_of(replaced(good, "\"assumed\"", "\"asumed\"")) ==
        "rows.json /rows/0/asumed: unknown key; did you mean \"assumed\"?");
  CHECK(
      message_of(replaced(good, ", \"reduced\": [\"half the time\"]", "")) ==
      "rows.json /runs/overfill/reduced/reduced: is missing; a reduced form must say what it leaves out, in a list of "
      "sentences");
  CHECK(message_of(replaced(good, "\"full\": {\"case\": \"case.json\"}", "\"full\": {\"case\": \"cas.json\"}"))
            .find("rows.json /runs/overfill/full/case: \"cas.json\" does not exist") == 0);
  CHECK(message_of(rows_text(residue_row, "[1, 1]")) ==
        "rows.json /runs/overfill/seeds/1: stands twice; seeds must differ");
  CHECK(message_of(rows_text(residue_row, "[]")) ==
        "rows.json /runs/overfill/seeds: is an empty list; must hold at least one seed");
  CHECK(message_of(rows_text(std::string(residue_row) + "," + residue_row)) ==
        "rows.json /rows/1/name: another row is called \"Residue\"; names of rows must differ");
  CHECK(message_of(replaced(good, "\"assumed\"", "\"against_scatter\": true, \"assumed\"")) ==
        "rows.json /rows/0: is judged against the scatter of seeds; /calx/minus must name the run it is the difference "
        "to");
}

TEST_CASE("what the file sets in every run comes before a form's own changes") {
  const std::string all = R"("set": {"/time/end": 0.4, "/time/step": 1e-5}, )";
  const std::string good = rows_text(residue_row);
  const Files files(replaced(good, "\"runs\"", all + "\"runs\""));
  const PaperRows read = files.paper();
  const PaperForm& form = paper_run(read, "overfill").forms[paper_reduced];
  REQUIRE(form.set.size() == 3);
  CHECK(form.set[0] == std::pair<std::string, std::string>("/time/end", "0.4"));
  CHECK(form.set[2] == std::pair<std::string, std::string>("/time/end", "0.5"));
  const nlohmann::json resolved = nlohmann::json::parse(read_case(form.case_path, paper_overrides(form, 1)).resolved);
  CHECK(resolved["time"]["end"] == 0.5);
  CHECK(resolved["time"]["step"] == 1e-5);
  CHECK(message_of(replaced(good, "\"runs\"", "\"set\": {\"time/end\": 1}, \"runs\"")) ==
        "rows.json /set/time~1end: \"time/end\" is no JSON pointer; must start with /, such as \"/time/end\"");
}
