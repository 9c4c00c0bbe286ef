// The page of a diagnosis: what stands there for each verdict, the sign in words, and what happens when files are
// missing.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include "base/error.hpp"
#include "page_text.hpp"
#include "report/diagnosis_page.hpp"
#include "report/diagnosis_page_words.hpp"
#include "sample_diagnosis.hpp"
#include "scratch_folder.hpp"

using namespace calx;
using calx_test::charts_of;
using calx_test::has;
using calx_test::sample_diagnosis;
using calx_test::ScratchFolder;
using calx_test::slurp;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

bool shows_nan(const std::string& page) { return std::regex_search(page, std::regex("\\b(nan|inf)\\b")); }

/// The body of the page: without the style and scripts, which hold words of their own.
std::string page_of(const json& diagnosis) {
  const ScratchFolder folder;
  calx_test::write_sample_diagnosis(folder.path(), diagnosis);
  const std::string page = slurp(write_diagnosis_report(folder.path()));
  return page.substr(page.find("<header>"), page.find("<footer>") - page.find("<header>"));
}

json charts_of_page(const json& diagnosis) {
  const ScratchFolder folder;
  calx_test::write_sample_diagnosis(folder.path(), diagnosis);
  return charts_of(slurp(write_diagnosis_report(folder.path())));
}

json with_verdict(const std::string& verdict) {
  json j = sample_diagnosis();
  j["verdict"] = verdict;
  for (json& c : j["causes"]) c["named"] = false;
  j["after_holds"] = json::array();
  j["extensions"] = json::object();
  j["confirmation"] = nullptr;
  return j;
}

std::string error_of(const std::string& text) {
  const ScratchFolder folder;
  std::ofstream(folder.path() + "/diagnosis.json") << text;
  try {
    write_diagnosis_report(folder.path());
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::files);
    const std::string what = e.what();
    return what.substr(what.find("diagnosis.json"));
  }
  return "written without an error";
}

}  // namespace

TEST_CASE("runs that contradict the forecast are said to, and the lone cause that is left is no more than likeliest") {
  json j = sample_diagnosis();
  CHECK(has(page_of(j), "The improvement is there."));
  CHECK(has(page_of(j), "confirm it"));
  const json runs = j["confirmation"];
  j = with_verdict("ambiguous");
  j["set"] = {j["causes"][0]["id"]};
  j["confirmation"] = runs;
  j["confirmation"]["contradicted"] = true, j["confirmation"]["error_foretold"] = 0.321;
  const std::string page = page_of(j);
  CHECK(has(page, "The improvement is not what was foretold."));
  CHECK(has(page, "instead of 0.321 sd"));
  CHECK(has(
      page,
      "<div class=\"card bad\"><span class=\"name\">runs with new seeds</span><span class=\"value\">do not confirm"));
  CHECK(has(page, "Likeliest is "));
  CHECK_FALSE(has(page, "Still possible"));
}

TEST_CASE("the error in words follows simulation less measurement") {
  CHECK(error_html(1.5, "g") == "1.5\xc2\xa0g too much");
  CHECK(error_html(-0.77, "g") == "0.77\xc2\xa0g too little");
  const std::string page = page_of(sample_diagnosis());
  CHECK(has(page, "1.5\xc2\xa0g too much"));
  CHECK(has(page, "0.8\xc2\xa0g too little"));
}

TEST_CASE("p values are told as how often chance does that") {
  CHECK(chance_html(0.7) == "yes, easily");
  CHECK(chance_html(0.1) == "yes, about once in 10 times");
  CHECK(chance_html(0.02) == "hardly, about once in 50 times");
  CHECK(chance_html(0.0025) == "no, once in 400 times at most");
  CHECK(chance_html(1.0 / 401) == "no, once in 400 times at most");
  CHECK(chance_html(1e-12) == "no, less than once in a million times");
  CHECK(chance_html(DiagnosisResult::unknown) == "not known");
}

TEST_CASE("numbers are digits where a person reads digits, and quantities have prefixes") {
  CHECK(number_html(100, 2) == "100");
  CHECK(number_html(169.87, 2) == "170");
  CHECK(number_html(12345.6) ==
        "12\xc2\xa0"
        "300");
  CHECK(number_html(9.7e-13, 2) ==
        "9.7\xc2\xb7"
        "10<sup>-13</sup>");
  CHECK(quantity_html(0.0023729, "m") == "2.37\xc2\xa0mm");
  CHECK(range_html(0.0009, 0.00295, "m") == "0.9 to 2.95\xc2\xa0mm");
  CHECK(range_html(0, 0.99, "1") == "0 to 0.99");
}

TEST_CASE("nats are told as likelihood, shares never as certainty") {
  CHECK(likelier_html(3) == "20 times likelier");
  CHECK(likelier_html(-3) == "20 times less likely");
  CHECK(likelier_html(0.01) == "as likely");
  CHECK(likelier_html(30) == "over a million times likelier");
  CHECK(share_html(1) == "above 99.9\xc2\xa0%");
  CHECK(share_html(0) == "below 0.1\xc2\xa0%");
  CHECK(share_html(0.424) == "42\xc2\xa0%");
}

TEST_CASE("a named cause is told with its strength, evidence, rivals, gain and case") {
  const std::string page = page_of(sample_diagnosis());
  CHECK(has(page, "<h1>A valve &amp; its &lt;leak&gt;</h1>"));
  CHECK(has(page,
            "<div class=\"verdict named\"><span class=\"status\">cause named</span><h2>Powder leaks between rotor "
            "and housing</h2>"));
  CHECK(has(page, "gap = <b>2\xc2\xa0mm</b> (90\xc2\xa0% interval 1.6 to 2.4\xc2\xa0mm)"));
  CHECK(has(page, "Look for it at the plant"));
  CHECK(has(page, "<code>calx.leak</code> <span class=\"tag\">named</span>"));
  CHECK(has(page, "style=\"width:96%\""));
  CHECK(has(page, "each below 1\xc2\xa0%: <code>calx.tilt</code>."));
  CHECK(has(page, "<code>calx.leak</code> and <code>calx.worn-pocket</code> leave the same traces."));
  CHECK(has(page, "turn the rotor slower: a leak grows with time"));
  CHECK(has(page, "<li class=\"bad\"><b>calx.interlocking: contradicted.</b>"));
  CHECK(has(page, "{&quot;title&quot;: &quot;with &lt;leak&gt;&quot;}"));
  CHECK(has(page, ">copy</button>"));
  CHECK(has(page, "strained without the cause"));
  CHECK(has(page,
            "3\xc2\xa0"
            "000 times likelier with the cause"));
  CHECK(has(page, "at least 20 times are asked for"));
  CHECK(has(page, "The improvement is there."));
  CHECK(has(page,
            "of strength 2.1\xc2\xa0mm would be named right 85\xc2\xa0% <small>(34 of 40)</small>, wrong "
            "3\xc2\xa0% <small>(1 of 40)</small>"));
  CHECK(has(page, "<b>flow by angle</b> tells most for its cost"));
  CHECK(has(page, "the case has no air"));
  CHECK(has(page, "<td>a, b</td><td>20.78</td></tr>"));
  CHECK_FALSE(has(page, "ab12"));
  CHECK(has(page, "5\xc2\xa0min of run time in all"));
  CHECK(has(
      page,
      "<span class=\"value\">80</span><span class=\"note\">5\xc2\xa0min of run time; planned at most 122, budget 150"));
}

TEST_CASE("causes stand in the order of their evidence, wherever they stand in the file") {
  json j = sample_diagnosis();
  std::reverse(j["causes"].begin(), j["causes"].end());
  const std::string page = page_of(j);
  const std::size_t why = page.find("<section id=\"why\">");
  CHECK(page.find("calx.leak", why) < page.find("calx.worn-pocket", why));
}

TEST_CASE("causes that may act beside the named one are told") {
  json j = sample_diagnosis();
  CHECK_FALSE(has(page_of(j), "Perhaps at work beside it"));
  j["causes"][1]["probability"] = 0.4;
  CHECK(has(page_of(j), "Perhaps at work beside it: <code>calx.worn-pocket</code> (40\xc2\xa0%)."));
  j["causes"][1]["dropped"] = true;
  const std::string page = page_of(j);
  CHECK_FALSE(has(page, "Perhaps at work beside it"));
  CHECK(has(page, "<code>calx.worn-pocket</code> looked likely beside it, but adds nothing when it is run"));
}

TEST_CASE("two causes by one effect are told apart by their parameter") {
  json j = sample_diagnosis();
  j["causes"][1]["id"] = "calx.leak", j["causes"][1]["amplitude"] = "width";
  const std::string page = page_of(j);
  CHECK(has(page, "<code>calx.leak gap</code>"));
  CHECK(has(page, "<code>calx.leak width</code>"));
}

TEST_CASE("an instrument at fault sends the reader to the instrument") {
  json j = sample_diagnosis();
  j["causes"][0]["instrument"] = true;
  CHECK(has(page_of(j), "Check the instrument"));
  CHECK_FALSE(has(page_of(sample_diagnosis()), "Check the instrument"));
}

TEST_CASE("residuals are measured less simulated, fitted and held out apart, with the cause") {
  const json charts = charts_of_page(sample_diagnosis());
  const auto chart = [&](const std::string& title, std::size_t which) {
    for (const json& c : charts)
      if (c["title"] == title && which-- == 0) return c;
    return json();
  };
  const json fitted = chart("hopper, fast", 0), held = chart("hopper, slow", 0), worth = chart("hopper, slow", 1);
  CHECK(fitted["series"][0]["style"] == "band");
  CHECK(fitted["series"][0]["error"] == json({0.6, 0.6, 0.6, 0.6}));
  CHECK(fitted["series"][1]["name"] == "with the cause");
  CHECK(fitted["series"][1]["y"] == json({0, -1, -2, -2.5}));
  CHECK(fitted["series"][2]["name"] == "measured, fitted");
  CHECK(fitted["series"][2]["y"] == json({0, -1, -2, -3}));
  CHECK(held["series"][2]["name"] == "measured, held out");
  CHECK(held["series"][2]["y"] == json({0, -1, -2, -3}));
  // Simulated less measured there; the rows of the second observable are those of the runs.
  CHECK(worth["series"][1]["y"] == json({0, 1, 2, 3}));
  CHECK(worth["series"][2]["y"] == json({0, 0, 0, 0.5}));
  CHECK(worth["series"][4]["y"] == json({0, 0, 0, 0.4}));
  CHECK(chart("Single values", 0)["x"]["categories"] == json({"residue"}));
}

TEST_CASE("held-out errors are computed from the numbers, and what got worse is told") {
  const std::string page = page_of(sample_diagnosis());
  // Errors 0, 1, 2, 3 g: mean 1.5 g, root mean square 1.871 g = 3.7 sd; after: 0.5 g at the last one.
  CHECK(has(page,
            "<td>hopper, slow</td><td>1.5\xc2\xa0g too much</td><td>0.125\xc2\xa0g too much</td><td "
            "class=\"n\">3.7</td><td class=\"n\">0.5</td>"));
  CHECK(has(page, "No observable got worse."));
  json j = sample_diagnosis();
  j["observables"][0]["after"] = {45, 44, 43, 42};
  CHECK(has(page_of(j), "hopper, fast got worse."));
  CHECK_FALSE(has(page_of(j), "No observable got worse."));
}

TEST_CASE("distances below 3 are shaded as alike") {
  const std::string page = page_of(sample_diagnosis());
  // True cause calx.leak, imitated by the second one.
  CHECK(
      has(page,
          "<td><code>calx.leak</code></td><td class=\"n\"></td><td class=\"n\"><span class=\"shade near\">2.5</span>"));
  CHECK(has(page, "<span class=\"shade middle\">4</span>"));
  CHECK(has(page, "<span class=\"shade far\">7</span>"));
}

TEST_CASE("nothing wrong is said with its limits and without an extended case") {
  json j = with_verdict("none");
  const std::string page = page_of(j);
  CHECK(has(page, "<div class=\"verdict none\">"));
  CHECK(has(page, "Nothing is shown to be wrong</h2>"));
  CHECK(has(page, "That is no proof"));
  CHECK(has(page, "No cause is named, so the case stays as it is"));
  CHECK(has(page, "No cause was added, so that there is nothing to compare."));
  CHECK_FALSE(has(page, "With the cause</th>"));
  CHECK_FALSE(has(page, "strained without the cause"));
}

TEST_CASE("an ambiguous verdict names what is left and what to measure") {
  json j = with_verdict("ambiguous");
  j["reason"] = "several explanations are left";
  j["set"] = {"calx.leak", "calx.worn-pocket", "unknown"};
  std::string page = page_of(j);
  CHECK(has(page, "<div class=\"verdict ambiguous\">"));
  CHECK(has(page,
            "Still possible: the causes <code>calx.leak</code> and <code>calx.worn-pocket</code>; something that is "
            "not in the library."));
  CHECK(has(page,
            "<b>flow by angle</b> tells most for its cost; a clear verdict after it has a probability of "
            "80\xc2\xa0%"));
  j["next"] = json::array();
  page = page_of(j);
  CHECK(has(page, "Measure something else"));
  CHECK(has(page, "List those you could make under &quot;experiments&quot;"));
}

TEST_CASE("an unknown is told in words and never called a cause") {
  json j = with_verdict("unknown");
  j["unknown_terms"] = {{{"observable", "hopper, fast"},
                         {"family", "step"},
                         {"words", "hopper, fast: a step of -1.2 +/- 0.2 at 1.5"},
                         {"gain_nats", 9},
                         {"stability", 0.75}}};
  const std::string page = page_of(j);
  CHECK(has(page, "<div class=\"verdict unknown\">"));
  CHECK(has(page, "It looks like this: <b>hopper, fast: a step of -1.2 +/- 0.2 at 1.5</b>"));
  CHECK(has(page, "a jump that stays"));
  CHECK(has(page, "<td class=\"n\">75\xc2\xa0%</td>"));
  CHECK(has(page, "they are no cause"));
  CHECK(has(page, "<small>in g, against time in s</small>"));
  CHECK_FALSE(has(page, "Recalibrated with the cause"));
  CHECK(has(page, "with the unknown term than with the recalibrated simulation"));
}

TEST_CASE("files that are missing leave a sentence") {
  const ScratchFolder folder;
  calx_test::write_sample_diagnosis(folder.path(), sample_diagnosis());
  for (const char* name : {"/cost.json", "/runs.csv", "/extension/fast.json"}) fs::remove(folder.path() + name);
  const std::string page = slurp(write_diagnosis_report(folder.path()));
  CHECK(has(page, "No cost: cost.json is not there."));
  CHECK(has(page, "No list of runs: runs.csv is not there."));
  CHECK(has(page, "The file extension/fast.json is not there."));
}

TEST_CASE("a verdict alone still gives a page of every section") {
  for (const char* verdict : {"named", "none", "ambiguous", "unknown", "of a later version"}) {
    const std::string page = page_of({{"verdict", verdict}});
    for (const char* id : {"wrong", "why", "model", "worth", "trust", "next", "limits", "provenance"})
      CHECK(has(page, "<section id=\"" + std::string(id) + "\">"));
    CHECK(has(page, "diagnosis.json holds no observables."));
    CHECK_FALSE(shows_nan(page));
  }
}

TEST_CASE("keys taken away one by one leave a page without holes") {
  const json whole = sample_diagnosis();
  for (const auto& [key, value] : whole.items()) {
    if (key == "verdict") continue;
    CAPTURE(key);
    json j = whole;
    j.erase(key);
    CHECK(has(page_of(j), "<section id=\"provenance\">"));
    j[key] = 3;
    CHECK(has(page_of(j), "<section id=\"provenance\">"));
  }
  for (const char* list : {"causes", "observables", "nuisances", "next", "claims", "untested"})
    for (const auto& [key, value] : whole[list][0].items()) {
      CAPTURE(list);
      CAPTURE(key);
      json j = whole;
      j[list][0].erase(key);
      const std::string page = page_of(j);
      CHECK(has(page, "<section id=\"provenance\">"));
      CHECK_FALSE(shows_nan(page));
    }
}

TEST_CASE("what is no result of a diagnosis is refused") {
  CHECK(error_of("{") == "diagnosis.json: is no valid JSON; run calx diagnose again");
  CHECK(error_of("{\"parameters\": []}") == "diagnosis.json: holds no \"verdict\"; must be what calx diagnose wrote");
  CHECK_THROWS_AS(write_diagnosis_report("/does/not/exist"), Error);
}
