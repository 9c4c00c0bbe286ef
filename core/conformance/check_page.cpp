// check_page.cpp: the result of the checks as text, as JSON and as a page with the curves of a law or a motion and the
// shape of a geometry.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/version.hpp"
#include "conformance/conformance.hpp"
#include "report/page.hpp"
#include "report/shape_picture.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const char* word(CheckOutcome outcome) {
  return outcome == CheckOutcome::passed ? "passed" : outcome == CheckOutcome::failed ? "FAILED" : "skipped";
}

std::string totals(const CheckReport& report) {
  return std::to_string(report.count(CheckOutcome::passed)) + " passed, " +
         std::to_string(report.count(CheckOutcome::failed)) + " failed, " +
         std::to_string(report.count(CheckOutcome::skipped)) + " skipped; seed " + std::to_string(report.seed);
}

Chart chart_of(const std::string& which) {
  Chart chart;
  if (which == "normal") {
    chart.title = "Force over overlap";
    chart.caption = "Two spheres of 1 mm radius and 2500 kg/m^3, pressed slowly and released; presets of the pair.";
    chart.x = {"overlap", "m", true, {}};
    chart.y = {"normal force", "N", false, {}};
  } else if (which == "restitution") {
    chart.title = "Restitution over speed";
    chart.caption = "Head-on impacts of two such spheres; 0: they stay together, above 1: the law creates energy.";
    chart.x = {"speed before", "m/s", false, {}, true};
    chart.y = {"speed after over before", "1", true, {}};
  } else if (which == "tangential") {
    chart.title = "Tangential loop";
    chart.caption = "Pressed to half of the overlap of an impact at 0.1 m/s, then sheared to and fro.";
    chart.x = {"tangential displacement", "m", false, {}};
    chart.y = {"tangential force", "N", false, {}};
  } else if (which == "shift") {
    chart.title = "Displacement over time";
    chart.caption = "Length of the displacement, with the sign of its largest component.";
    chart.x = {"time", "s", true, {}};
    chart.y = {"displacement", "m", false, {}};
  } else {
    chart.title = "Angle over time";
    chart.x = {"time", "s", true, {}};
    chart.y = {"angle", "deg", false, {}};
  }
  return chart;
}

/// In a unit that suits the numbers; one for all curves of a chart.
void rescale(ChartAxis& axis, std::vector<ChartSeries>& series, std::vector<double> ChartSeries::*values) {
  double largest = 0;
  for (const ChartSeries& s : series)
    for (const double v : s.*values) largest = std::max(largest, std::fabs(v));
  const DisplayUnit unit = display_unit(axis.unit, largest);
  axis.unit = unit.unit;
  for (ChartSeries& s : series)
    for (double& v : s.*values) v *= unit.factor;
}

std::string charts(Page& page, const std::vector<CheckCurve>& curves) {
  std::string out;
  for (const char* which : {"normal", "restitution", "tangential", "shift", "turn"}) {
    Chart chart = chart_of(which);
    for (const CheckCurve& curve : curves) {
      if (curve.chart != which) continue;
      ChartSeries series;
      series.name = curve.name;
      series.x = curve.x;
      series.y = curve.y;
      chart.series.push_back(series);
    }
    if (chart.series.empty()) continue;
    rescale(chart.x, chart.series, &ChartSeries::x);
    rescale(chart.y, chart.series, &ChartSeries::y);
    out += page.chart(chart);
  }
  return out.empty() ? "" : "<div class=\"charts\">" + out + "</div>";
}

std::string pictures(const std::vector<CheckShape>& shapes) {
  std::string out;
  for (const CheckShape& shape : shapes) {
    std::vector<Vec3> vertices;
    for (std::size_t k = 0; k + 2 < shape.vertices.size(); k += 3)
      vertices.push_back({shape.vertices[k], shape.vertices[k + 1], shape.vertices[k + 2]});
    out += "<figure>" + draw_shape(vertices, shape.triangles) + "<figcaption>" + html_text(shape.name) +
           ": blue seen from outside, orange from inside.</figcaption></figure>";
  }
  return out.empty() ? "" : "<div class=\"charts\">" + out + "</div>";
}

}  // namespace

std::string check_text(const CheckReport& report, bool all) {
  std::size_t width = 0;
  for (const CheckedManifest& manifest : report.manifests)
    for (const CheckResult& result : manifest.results) width = std::max(width, result.name.size());
  std::string out;
  for (const CheckedManifest& manifest : report.manifests) {
    std::string subject;
    for (const CheckResult& result : manifest.results) {
      if (!all && result.outcome != CheckOutcome::failed) continue;
      if (result.subject != subject) out += result.subject + "\n";
      subject = result.subject;
      out += std::string("  ") + word(result.outcome) + "  " + result.name;
      out.append(width - result.name.size() + 2, ' ');
      out += result.meaning + "\n";
      if (!result.detail.empty()) out += "           " + result.detail + "\n";
    }
  }
  // Once more where the eye rests: between dozens of passed checks a failed one is overlooked.
  if (all)
    for (const CheckedManifest& manifest : report.manifests)
      for (const CheckResult& result : manifest.results)
        if (result.outcome == CheckOutcome::failed)
          out += "\nfailed: " + result.name + " of " + result.subject + "\n  " + result.detail + "\n";
  return out + "\n" + totals(report) + "\n";
}

std::string check_json(const CheckReport& report) {
  using nlohmann::json;
  json out = {{"seed", report.seed},
              {"passed", report.count(CheckOutcome::passed)},
              {"failed", report.count(CheckOutcome::failed)},
              {"skipped", report.count(CheckOutcome::skipped)},
              {"manifests", json::array()}};
  for (const CheckedManifest& manifest : report.manifests) {
    json checks = json::array();
    for (const CheckResult& result : manifest.results)
      checks.push_back({{"name", result.name},
                        {"meaning", result.meaning},
                        {"subject", result.subject},
                        {"outcome", result.outcome == CheckOutcome::failed ? "failed" : word(result.outcome)},
                        {"detail", result.detail}});
    out["manifests"].push_back({{"path", manifest.path}, {"checks", checks}});
  }
  return out.dump(2, ' ', true, json::error_handler_t::replace) + "\n";
}

void write_check_page(const CheckReport& report, const std::string& file) {
  Page page("calx plugin check");
  std::string failures;
  for (const CheckedManifest& manifest : report.manifests)
    for (const CheckResult& result : manifest.results)
      if (result.outcome == CheckOutcome::failed)
        failures += html_check("bad", html_text(result.name + " of " + result.subject), html_text(result.detail));
  page.header("<h1>Plugin check</h1><p><span class=\"status " + std::string(failures.empty() ? "good" : "bad") + "\">" +
              html_text(totals(report)) + "</span> Calx " + html_text(version()) + "</p>" +
              (failures.empty() ? "" : "<ul class=\"checks\">" + failures + "</ul>"));
  std::size_t number = 0;
  for (const CheckedManifest& manifest : report.manifests) {
    // A table for the library and one for each of its plugins.
    std::string tables;
    for (std::size_t k = 0; k < manifest.results.size();) {
      const std::string& subject = manifest.results[k].subject;
      std::vector<std::vector<std::string>> rows = {{"check", "outcome", "meaning", "found"}};
      for (; k < manifest.results.size() && manifest.results[k].subject == subject; ++k) {
        const CheckResult& result = manifest.results[k];
        rows.push_back({html_text(result.name),
                        result.outcome == CheckOutcome::failed ? "<strong>failed</strong>" : word(result.outcome),
                        html_text(result.meaning), html_text(result.detail)});
      }
      tables += "<h3>" + html_text(subject) + "</h3>" + html_table(rows, rows[0].size());
    }
    const std::string name = std::filesystem::path(manifest.path).filename().string();
    const std::string head = name.substr(0, name.find(".plugin.json"));
    page.section(
        "manifest" + std::to_string(number++), html_text(head), head,
        pictures(manifest.shapes) + charts(page, manifest.curves) + tables + "<p>" + html_text(manifest.path) + "</p>");
  }
  std::ofstream out(file, std::ios::binary);
  out << page.html();
  if (!out.flush()) throw Error(Fault::files, file + " cannot be written");
}

}  // namespace calx
