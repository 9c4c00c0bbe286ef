// The page in a real browser without a network: every chart drawn, pictures taken, nothing on the console.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "page_text.hpp"
#include "report/diagnosis_page.hpp"
#include "report/report.hpp"
#include "sample_diagnosis.hpp"
#include "sample_run.hpp"
#include "scratch_folder.hpp"

using calx_test::ScratchFolder;
using calx_test::slurp;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null 2>&1").c_str()) == 0) return name;
  }
  return "";
}

struct Visit {
  std::string dom;
  std::vector<std::string> complaints;  // console lines but for the driver's remarks on speed
};

Visit visit(const std::string& page, const std::string& scratch) {
  const std::string command =
      "timeout 120 " + browser() +
      " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr --virtual-time-budget=15000 "
      "--window-size=1280,900 "
      "--user-data-dir=" +
      scratch + "/profile --dump-dom file://" + page + " >" + scratch + "/dom 2>" + scratch + "/log";
  const int status = std::system(command.c_str());
  CHECK(status == 0);
  Visit out;
  out.dom = slurp(scratch + "/dom");
  std::istringstream log(slurp(scratch + "/log"));
  for (std::string line; std::getline(log, line);) {
    if (line.find("CONSOLE") != std::string::npos && line.find("GL Driver Message") == std::string::npos)
      out.complaints.push_back(line);
  }
  return out;
}

}  // namespace

TEST_CASE("every chart and picture is drawn and the console stays empty") {
  if (browser().empty()) {
    MESSAGE("skipped: no Chromium found (package chromium)");
    return;
  }
  const ScratchFolder folder;
  calx_test::SampleOptions options;
  options.grains = 400;
  options.frames_every = 2;
  options.sample_every = 0.05;
  calx_test::write_sample_run(folder.path(), options);
  const Visit seen = visit(calx::write_report(folder.path()), folder.path());
  for (const std::string& line : seen.complaints) FAIL_CHECK(line);
  const std::size_t plots = count(seen.dom, "class=\"plot\" data-chart=");
  CHECK(plots >= 25);
  // One svg in each plot: a chart that failed leaves its element empty.
  CHECK(count(seen.dom, "class=\"plot\" data-chart=") - count(seen.dom, "\"></div></figure>") == plots);
  CHECK(count(seen.dom, "<div class=\"tip\"") == plots);
  CHECK(count(seen.dom, "<img src=\"data:image/png;base64,") == 4);
  CHECK(count(seen.dom, "class=\"section-picture\"") == 3);
  CHECK(seen.dom.find("<small>after: valve open</small>") != std::string::npos);
  CHECK(seen.dom.find("<p class=\"absent\">3-D pictures") == std::string::npos);
  // A blank picture of this size compresses to a few kB.
  const std::size_t picture = seen.dom.find("<img src=\"data:image/png;base64,");
  CHECK(seen.dom.find('"', picture + 12) - picture > 20000);
}

TEST_CASE("every chart of a diagnosis is drawn, with its bands") {
  if (browser().empty()) return;
  const ScratchFolder folder;
  calx_test::write_sample_diagnosis(folder.path(), calx_test::sample_diagnosis());
  const Visit seen = visit(calx::write_diagnosis_report(folder.path()), folder.path());
  for (const std::string& line : seen.complaints) FAIL_CHECK(line);
  // Two residual plots, the single value, the held-out curve, the calibration curve.
  CHECK(count(seen.dom, "class=\"plot\" data-chart=") == 5);
  CHECK(count(seen.dom, "<div class=\"tip\"") == 5);
  // One in each but the calibration curve.
  CHECK(count(seen.dom, "opacity=\"0.16\"") == 4);
}

TEST_CASE("the playback's controls work") {
  if (browser().empty()) return;
  const ScratchFolder folder;
  calx_test::SampleOptions options;
  options.grains = 200;
  options.frames_every = 2;
  options.sample_every = 0.5;
  calx_test::write_sample_run(folder.path(), options);
  std::string page = slurp(calx::write_report(folder.path()));
  // Without a screen the browser gives no animation frames; a timer stands in for them.
  page.insert(page.find("<header>"),
              "<script>window.requestAnimationFrame = function (f) { return setTimeout(function () { "
              "f(performance.now()); }, 20); };</script>");
  // Sets every control, leaves what the clock says in the page's text, then plays for a while.
  page.insert(page.rfind("</body>"), R"(<pre id="protocol"></pre><script>
    var protocol = document.getElementById("protocol"), clock = document.querySelector(".clock");
    function say(text) { protocol.textContent += "[" + text + "]"; }
    function set(id, value, event) { var e = document.getElementById(id); e.value = value; e.dispatchEvent(new Event(event)); }
    document.getElementById("smooth").click();
    set("slider", 500, "input"); say("middle " + clock.firstChild.textContent);
    document.getElementById("smooth").click();
    set("slider", 500, "input"); say("smooth " + clock.firstChild.textContent);
    set("cut", "none", "change"); set("cut", "parts", "change"); set("cut-angle", 90, "input");
    set("opacity", 30, "input"); set("colour", "radius", "change"); say(document.getElementById("scale").textContent);
    document.querySelectorAll("#views button").forEach(function (b) { b.click(); });
    document.querySelectorAll("#parts button").forEach(function (b) { b.click(); });
    say(document.querySelectorAll("#parts button.off").length + " parts hidden");
    set("rate", "2", "change");
    document.getElementById("play").click();
    setTimeout(function () { document.getElementById("play").click(); say(parseFloat(clock.textContent.slice(4)) > 11.5 ? "it moves" : "it stands"); }, 3000);
    </script>)");
  std::ofstream(folder.path() + "/touched.html") << page;
  const Visit seen = visit(folder.path() + "/touched.html", folder.path());
  for (const std::string& line : seen.complaints) FAIL_CHECK(line);
  const std::size_t from = seen.dom.find("<pre id=\"protocol\">");
  REQUIRE(from != std::string::npos);
  const std::string protocol = seen.dom.substr(from, seen.dom.find("</pre>", from) - from);
  CAPTURE(protocol);
  // Frames stand every 2 s from 0 to 22 s.
  CHECK(protocol.find("[middle t = 10.000 s]") != std::string::npos);
  CHECK(protocol.find("[smooth t = 11.000 s]") != std::string::npos);
  CHECK(protocol.find("3.6 mm]") != std::string::npos);
  CHECK(protocol.find("[5 parts hidden]") != std::string::npos);
  CHECK(protocol.find("[it moves]") != std::string::npos);
}

TEST_CASE("a page of an empty folder works too") {
  if (browser().empty()) return;
  const ScratchFolder folder;
  const Visit seen = visit(calx::write_report(folder.path()), folder.path());
  CHECK(seen.complaints.empty());
  CHECK(seen.dom.find("No provenance:") != std::string::npos);
}

TEST_CASE("the check itself sees a script that fails and a request that is made") {
  if (browser().empty()) return;
  const ScratchFolder folder;
  std::string page = slurp(calx::write_report(folder.path()));
  page.insert(page.find("</body>"), "<script>missingFunction();</script><img src=\"http://calx.invalid/a.png\">");
  std::ofstream(folder.path() + "/broken.html") << page;
  const Visit seen = visit(folder.path() + "/broken.html", folder.path());
  std::string all;
  for (const std::string& line : seen.complaints) all += line;
  CHECK(all.find("missingFunction is not defined") != std::string::npos);
  CHECK(all.find("Content Security Policy") != std::string::npos);
}
