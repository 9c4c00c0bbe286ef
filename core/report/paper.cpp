#include "report/paper.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "report/page.hpp"
#include "report/paper_figures.hpp"
#include "report/paper_words.hpp"
#include "report/section_picture.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const char* const form_names[2] = {"full", "reduced"};

struct RowResults {
  PaperResult form[2];
};

std::string list(const std::vector<std::string>& sentences) {
  std::string out = "<ul>";
  for (const std::string& s : sentences) out += "<li>" + html_text(s) + "</li>";
  return out + "</ul>";
}

std::string folded(const std::string& summary, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  return "<details><summary>" + summary + " (" + std::to_string(sentences.size()) + ")</summary>" + list(sentences) +
         "</details>";
}

std::string check(const char* mood, const std::string& head, const std::string& text) {
  return "<li class=\"" + std::string(mood) + "\"><b>" + head + "</b> " + text + "</li>";
}

/// Where the mean of a form lies against the measurement, and whether the scatter of seeds is larger than that.
std::string against_measured(const PaperRow& row, const PaperResult& result) {
  if (result.spread.count == 0) return "";
  const PaperDifference d = difference_to(result.spread.mean, result.spread.mean, row.measured);
  std::string out = difference_html(d, row.measured, row.unit);
  if (d.known && result.spread.count > 1 && d.sign != 0 && std::fabs(d.amount) <= result.spread.deviation)
    out += ", less than one sd";
  return out;
}

std::string scatter_verdict(const PaperRow& row, const PaperResult& result) {
  if (!row.against_scatter || result.spread.count == 0) return "";
  const std::string unit = row.unit == "1" ? "" : "\xc2\xa0" + unit_html(row.unit);
  if (!(result.pooled > 0))
    return check("open", "Scatter of seeds not known.", "At least two seeds of each run are needed.");
  const bool inside = std::fabs(result.spread.mean) <= result.pooled;
  return check(
      inside ? "good" : "bad",
      inside ? "The difference is no larger than between seeds." : "The difference exceeds that between seeds.",
      "Difference of means " + format_number(result.spread.mean, 3) + unit + ", its standard error " +
          format_number(result.spread.deviation, 2) + unit + "; pooled sd between seeds " +
          format_number(result.pooled, 2) + unit + ".");
}

std::string claims(const PaperRow& row) {
  std::string out;
  const PaperDifference own = own_difference(row);
  for (const PaperClaim& c : row.claims) {
    const std::string said = "\"" + html_text(c.words) + "\" (" + html_text(c.where) + ")";
    if (!own.known || own.sign == c.sign)
      out += check("good", "The publication's words agree with its numbers:", said + ".");
    else
      out += check("bad", "The publication contradicts itself.",
                   said + " says " + (c.sign < 0 ? "underestimate" : "overestimate") + "; its numbers say " +
                       difference_html(own, row.measured, row.unit) + ". The numbers are what is compared here.");
  }
  return out;
}

std::string figures_table(const PaperRow& row, const RowResults& results) {
  std::vector<std::vector<std::string>> rows = {{"", "Figure", "Against the measurement"}};
  const auto small = [](const std::string& text) { return text.empty() ? "" : "<br><small>" + text + "</small>"; };
  const auto name = [&](const char* what, const PaperReference& r) {
    return what + (r.derived ? std::string(" <span class=\"tag\">derived</span>") : "") + small(html_text(r.where));
  };
  rows.push_back({name("Measured", row.measured), reference_html(row.measured, row.unit), ""});
  if (row.simulated.kind != PaperReference::Kind::none)
    rows.push_back({name("Paper's DEM", row.simulated), reference_html(row.simulated, row.unit),
                    difference_html(own_difference(row), row.measured, row.unit)});
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results.form[form];
    if (!r.exists) continue;
    std::string seeds = row.figure.minus_run.empty() ? "" : "standard error in place of the sd";
    for (const double v : r.values)
      if (row.figure.minus_run.empty()) seeds += (seeds.empty() ? "seeds: " : ", ") + format_number(v, 4);
    const bool is_drawn = !row.has_figure() && !r.runs.empty();
    rows.push_back({std::string("Calx, ") + form_names[form] + small(seeds),
                    r.spread.count > 0 ? result_html(r, row.unit)
                    : is_drawn         ? "see the plot"
                                       : "<i>not run</i>",
                    against_measured(row, r)});
  }
  return html_table(rows, 99);
}

/// Measured, the publication's simulation and every seed side by side.
void figure_chart(const PaperRow& row, const RowResults& results, std::vector<Chart>& charts) {
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
    const PaperResult& r = results.form[form];
    if (r.spread.count == 0) continue;
    const bool is_difference = !row.figure.minus_run.empty();
    add(std::string("Calx ") + form_names[form], is_difference ? std::vector<double>{r.spread.mean} : r.values,
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
  const std::vector<double>& values = with_y->values[static_cast<std::size_t>(y)];
  for (std::size_t k = 0, m = 0; k < values.size(); ++k) {
    while (m + 1 < with_x->time.size() && with_x->time[m + 1] <= with_y->time[k] * (1 + 1e-9)) ++m;
    if (!is_time && m >= with_x->time.size()) break;
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

std::string drawings(Page& page, const PaperRow& row, const RowResults& results) {
  std::string out;
  std::vector<Chart> charts;
  figure_chart(row, results, charts);
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results.form[form];
    if (r.runs.empty()) continue;
    for (const PaperPlot& plot : row.plots) {
      Chart chart;
      if (plot.picture)
        out += picture(plot, r);
      else if (curve_chart(plot, r, form_names[form], chart))
        charts.push_back(chart);
      else
        out += html_absent(plot.title + ": sensor \"" + plot.sensor + "\" gives no such curve.");
    }
  }
  std::string drawn;
  for (const Chart& chart : charts) drawn += page.chart(chart);
  return drawn + out;
}

std::string row_content(Page& page, const PaperRows& rows, const PaperRow& row, const RowResults& results,
                        const std::string& out) {
  const PaperRun& run = paper_run(rows, row.figure.run);
  std::string text = figures_table(row, results), checks = claims(row), links;
  for (const int form : {paper_reduced, paper_full}) {
    const PaperResult& r = results.form[form];
    checks += scatter_verdict(row, r);
    // A form that nobody began has said so in the table.
    if (!r.runs.empty() || form == paper_reduced)
      for (const std::string& m : r.missing) checks += check("open", "", html_text(m) + ".");
    for (const RunFolder& folder : r.runs)
      links += (links.empty() ? "Runs: " : ", ") + std::string("<a href=\"") +
               html_text(std::filesystem::path(folder.dir).lexically_relative(out).string()) + "/report.html\">" +
               form_names[form] + " " + std::filesystem::path(folder.dir).filename().string() + "</a>";
  }
  if (!checks.empty()) text += "<ul class=\"checks\">" + checks + "</ul>";
  for (const std::string& n : row.notes) text += "<p class=\"note\">" + html_text(n) + "</p>";
  if (!links.empty()) text += "<p class=\"note\">" + links + ".</p>";
  std::string assumed;
  if (!row.assumed.empty()) assumed += "<h3>Assumed</h3>" + list(row.assumed);
  const PaperForm& reduced = run.forms[paper_reduced];
  if (!reduced.reduced.empty()) assumed += "<h3>Reduced</h3>" + list(reduced.reduced);
  for (const int form : {paper_reduced, paper_full})
    if (!results.form[form].runs.empty())
      assumed += folded(std::string("Assumptions of the case, ") + form_names[form],
                        results.form[form].runs.front().assumptions);
  text = "<div class=\"two\"><div>" + text + "</div><div class=\"box assumed\">" + assumed + "</div></div>";
  const std::string drawn = drawings(page, row, results);
  return drawn.empty() ? text : text + "<div class=\"charts\">" + drawn + "</div>";
}

std::string anchor(std::size_t index) { return "row-" + std::to_string(index + 1); }

std::string overview(const PaperRows& rows, const std::vector<RowResults>& results) {
  std::vector<std::vector<std::string>> table = {{"Row", "Measured", "Paper's DEM", "Paper's DEM is an",
                                                  "Calx, reduced", "Calx, reduced, against the measurement",
                                                  "Calx, full"}};
  for (std::size_t k = 0; k < rows.rows.size(); ++k) {
    const PaperRow& row = rows.rows[k];
    const auto cell = [&](int form) -> std::string {
      const PaperResult& r = results[k].form[form];
      if (!r.exists) return "-";
      if (r.spread.count > 0) return result_html(r, row.unit);
      return !row.has_figure() && !r.runs.empty()
                 ? "shape only <small>(n\xc2\xa0=\xc2\xa0" + std::to_string(r.runs.size()) + ")</small>"
                 : "<i>not run</i>";
    };
    table.push_back({"<a href=\"#" + anchor(k) + "\">" + html_text(row.name) + "</a>",
                     reference_html(row.measured, row.unit), reference_html(row.simulated, row.unit),
                     side_html(own_difference(row), row.measured), cell(paper_reduced),
                     against_measured(row, results[k].form[paper_reduced]), cell(paper_full)});
  }
  return "<p>Mean \xc2\xb1 standard deviation over n seeds; a difference of two runs carries its standard error "
         "instead. Every figure comes from runs of this machine's folder; nothing is written by hand.</p>" +
         html_table(table, 99);
}

std::string card(const std::string& name, const std::string& value, const std::string& note) {
  return "<div class=\"card main\"><span class=\"name\">" + name + "</span><span class=\"value\">" + value +
         "</span><span class=\"note\">" + note + "</span></div>";
}

}  // namespace

std::string write_paper(const PaperRows& rows, std::size_t seeds, const std::string& out) {
  std::error_code failed;
  std::filesystem::create_directories(out, failed);
  if (failed) throw Error(Fault::files, out + ": cannot be made: " + failed.message());
  std::vector<RowResults> results(rows.rows.size());
  std::size_t filled[2] = {0, 0};
  for (std::size_t k = 0; k < rows.rows.size(); ++k)
    for (const int form : {paper_full, paper_reduced}) {
      PaperResult& r = results[k].form[form] = paper_result(rows, rows.rows[k], form, seeds, out);
      filled[form] += !rows.rows[k].has_figure() ? !r.runs.empty() : r.spread.count > 0;
    }
  Page page(rows.title);
  const std::string of = " of " + std::to_string(rows.rows.size());
  page.header(
      "<div class=\"title\"><h1>" + html_text(rows.title) + "</h1></div><p class=\"note\">" + html_text(rows.source) +
      "</p><div class=\"cards\">" +
      card("rows filled by reduced runs", std::to_string(filled[paper_reduced]) + of,
           "what was reduced stands in each row") +
      card("rows filled by full runs", std::to_string(filled[paper_full]) + of, "calx paper --full computes them") +
      "</div>" + (rows.intro.empty() ? "" : "<p>" + html_text(rows.intro) + "</p>"));
  page.section("rows", "All rows", "All rows", overview(rows, results));
  for (std::size_t first = 0; first < rows.rows.size();) {
    const std::string& group = rows.rows[first].group;
    std::string content;
    std::size_t k = first;
    for (; k < rows.rows.size() && rows.rows[k].group == group; ++k)
      content += "<div class=\"paper-row\" id=\"" + anchor(k) + "\"><h3>" + html_text(rows.rows[k].name) + "</h3>" +
                 row_content(page, rows, rows.rows[k], results[k], out) + "</div>";
    page.section("group-" + std::to_string(first), group, group, content);
    first = k;
  }
  const std::string path = out + "/paper.html";
  write_text_atomically(path, page.html());
  return path;
}

}  // namespace calx
