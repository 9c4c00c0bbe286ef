#include "report/paper_drawings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.hpp"
#include "report/paper_words.hpp"
#include "report/section_picture.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

/// Measured, the publication's simulation and every seed side by side.
void figure_chart(const PaperRow& row, const PaperResult (&results)[2], std::vector<Chart>& charts) {
  Chart chart;
  chart.title = row.name;
  chart.y = {"figure", row.unit == "1" ? "" : row.unit, false, {}};
  const auto add = [&](const std::string& name, const std::vector<double>& values, double error, int colour) {
    ChartSeries s{ChartSeries::Style::points, name, {}, values, {}, colour};
    s.x.assign(values.size(), static_cast<double>(chart.x.categories.size()));
    if (error > 0) s.error.assign(values.size(), error);
    chart.x.categories.push_back(name);
    chart.series.push_back(s);
  };
  const auto reference = [&](const std::string& name, const PaperReference& r, int colour) {
    if (r.kind == PaperReference::Kind::value || r.kind == PaperReference::Kind::range)
      add(name, {(r.low + r.high) / 2}, (r.high - r.low) / 2, colour);
  };
  reference("measured", row.measured, 6);
  reference("paper's DEM", row.simulated, 5);
  if (chart.series.empty()) return;
  bool any = false;
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results[form];
    if (r.spread.count == 0) continue;
    const bool is_difference = !row.figure.minus_run.empty();
    add(std::string("Calx ") + paper_form_name(form), is_difference ? std::vector<double>{r.spread.mean} : r.values,
        is_difference ? r.spread.deviation : 0, form == paper_full ? 2 : 0);
    any = true;
  }
  if (!any) return;
  chart.caption = "One point a seed; bars: a range, or the standard error of a difference.";
  charts.push_back(chart);
}

const SensorSeries* sensor_named(const RunFolder& run, const std::string& name) {
  for (const SensorSeries& s : run.sensors)
    if (s.name == name) return &s;
  return nullptr;
}

std::string picture(const PaperPlot& plot, const PaperResult& result) {
  const RunFolder& run = result.runs.front();
  if (run.frames.times.empty()) return html_absent(plot.title + ": " + run.dir + " holds no frame.");
  try {
    const FrameData frame = read_frame(run.dir, run.frames.times.size() - 1);
    double highest = 0;
    for (const float v : frame.speed) highest = std::max(highest, static_cast<double>(v));
    const SectionPicture drawn = draw_section(run.frames, frame, run.gravity, highest);
    if (drawn.svg.empty()) return "";
    return "<figure>" + drawn.svg + "<figcaption>" + html_text(plot.title) +
           ", t = " + format_quantity(run.frames.times.back(), "s", 4) + "</figcaption></figure>";
  } catch (const Error& e) {
    return html_absent(plot.title + ": " + e.what());
  }
}

/// Rows of one sensor's column against time, or against the last row then of another column.
bool columns_against_each_other(const PaperPlot& plot, const RunFolder& run, ChartSeries& line) {
  const SensorSeries* with_y = sensor_named(run, plot.sensor);
  const SensorSeries* with_x = plot.x_sensor.empty() ? with_y : sensor_named(run, plot.x_sensor);
  if (!with_y || !with_x) return false;
  const bool is_time = plot.x == "time_s";
  const int x = is_time ? -1 : with_x->column(plot.x), y = with_y->column(plot.y);
  if (y < 0 || (x < 0 && !is_time)) return false;
  const double begin =
      plot.since.empty() ? -1 : value_of(run.events, plot.since, std::numeric_limits<double>::infinity());
  const std::vector<double>& values = with_y->values[static_cast<std::size_t>(y)];
  for (std::size_t k = 0, m = 0; k < values.size(); ++k) {
    while (m + 1 < with_x->time.size() && with_x->time[m + 1] <= with_y->time[k] * (1 + 1e-9)) ++m;
    if (!is_time && m >= with_x->time.size()) break;
    if (with_y->time[k] < begin) continue;
    line.x.push_back(is_time ? with_y->time[k] : with_x->values[static_cast<std::size_t>(x)][m]);
    line.y.push_back(values[k]);
  }
  return !line.x.empty();
}

using Numbers = std::vector<double> ChartSeries::*;

double largest(const Chart& chart, Numbers which) {
  double out = 0;
  for (const ChartSeries& s : chart.series)
    for (const double v : s.*which) out = std::isfinite(v) ? std::max(out, std::fabs(v)) : out;
  return out;
}

/// Scales the numbers to what the rows file asks for, or to the prefix that suits them.
void set_axis(Chart& chart, ChartAxis& axis, Numbers which, const PaperAxis& wanted, const Quantity& column,
              double high) {
  const DisplayUnit unit =
      wanted.title.empty() ? display_unit(column.unit, high) : DisplayUnit{wanted.unit, wanted.factor};
  for (ChartSeries& s : chart.series)
    for (double& v : s.*which) v *= unit.factor;
  axis = {wanted.title.empty() ? column.title : wanted.title, unit.unit, false, {}};
}

/// One line a seed.
bool curve_chart(const PaperPlot& plot, const PaperResult& result, const std::string& form, Chart& chart) {
  chart.title = plot.title + " (" + form + ")";
  std::string x_name = plot.x, y_name = plot.y;
  for (const RunFolder& run : result.runs) {
    const std::string seed = std::filesystem::path(run.dir).filename().string();
    if (!plot.curve.empty()) {
      for (const auto& [sensor, curve] : run.curves) {
        if (sensor != plot.sensor || curve.name != plot.curve) continue;
        x_name = curve.x_name, y_name = curve.y_name;
        chart.series.push_back({ChartSeries::Style::line, seed, curve.x, curve.y, {}, -1});
      }
      continue;
    }
    ChartSeries line{ChartSeries::Style::line, seed, {}, {}, {}, -1};
    if (columns_against_each_other(plot, run, line)) chart.series.push_back(line);
  }
  const Quantity x = quantity_of(x_name), y = quantity_of(y_name);
  chart.equal_scales = x.unit == "m" && y.unit == "m";
  double high_x = largest(chart, &ChartSeries::x), high_y = largest(chart, &ChartSeries::y);
  if (chart.equal_scales) high_x = high_y = std::max(high_x, high_y);
  set_axis(chart, chart.x, &ChartSeries::x, plot.x_axis, x, high_x);
  set_axis(chart, chart.y, &ChartSeries::y, plot.y_axis, y, high_y);
  chart.y.from_zero = chart.equal_scales;
  return !chart.series.empty();
}

}  // namespace

std::string paper_drawings(Page& page, const PaperRow& row, const PaperResult (&results)[2]) {
  std::string out;
  std::vector<Chart> charts;
  figure_chart(row, results, charts);
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results[form];
    if (r.runs.empty()) continue;
    for (const PaperPlot& plot : row.plots) {
      Chart chart;
      if (plot.picture)
        out += picture(plot, r);
      else if (curve_chart(plot, r, paper_form_name(form), chart))
        charts.push_back(chart);
      else
        out += html_absent(plot.title + ": sensor \"" + plot.sensor + "\" gives no such curve.");
    }
  }
  std::string drawn;
  for (const Chart& chart : charts) drawn += page.chart(chart);
  return drawn + out;
}

}  // namespace calx
