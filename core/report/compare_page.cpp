// compare_page.cpp: two runs side by side, as text and as a page with their series one over the other.
#include <algorithm>
#include <cmath>

#include "base/text_table.hpp"
#include "report/compare.hpp"
#include "report/page.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

constexpr std::size_t kCharts = 60;  // more make a page that nobody scrolls through

std::string percent(double share) { return std::isfinite(share) ? format_number(100 * share, 4) + " %" : "-"; }

std::string share_text(const SeriesDifference& s) { return s.range > 0 ? percent(s.largest / s.range) : "-"; }

using Rows = std::vector<std::vector<std::string>>;

Rows given_rows(const std::vector<GivenDifference>& given) {
  Rows out;
  for (const GivenDifference& row : given) out.push_back({row.name, row.a, row.b});
  return out;
}

/// Figures that differ.
Rows figure_rows(const RunComparison& c) {
  Rows out;
  for (const FigureDifference& f : c.figures)
    if (!(f.difference == 0))  // also what is no number
      out.push_back(
          {f.name, format_number(f.a, 6), format_number(f.b, 6), format_number(f.difference, 4), percent(f.relative)});
  return out;
}

Rows series_rows(const RunComparison& c) {
  Rows out;
  for (const SeriesDifference& s : c.series)
    if (!s.same)
      out.push_back({s.sensor + " " + s.column, format_number(s.largest, 4), share_text(s), format_number(s.at, 5),
                     std::to_string(s.rows)});
  return out;
}

std::string alike(std::size_t all, std::size_t differ, const std::string& what) {
  return std::to_string(differ) + " of " + std::to_string(all) + " " + what + " differ";
}

std::string lacking(const std::vector<std::string>& names, const std::string& who) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "only in " + who + ": " : ", ") + name;
  return out;
}

Chart overlay(const RunComparison& c, const SeriesDifference& s) {
  const Quantity quantity = quantity_of(s.column);
  const DisplayUnit unit = display_unit(quantity.unit, s.range);
  Chart chart;
  chart.title = s.sensor + ": " + quantity.title;
  chart.caption = "Largest difference " + format_quantity(s.largest, quantity.unit) + ", " + share_text(s) +
                  " of the largest value, at " + format_quantity(s.at, "s") + ".";
  chart.x = {"time", "s", false, {}};
  chart.y = {quantity.title, unit.unit, false, {}};
  const RunFolder* const runs[] = {&c.a, &c.b};
  for (int k = 0; k < 2; ++k)
    for (const SensorSeries& sensor : runs[k]->sensors) {
      const int column = sensor.column(s.column);
      if (sensor.name != s.sensor || column < 0) continue;
      ChartSeries line;
      line.style = k == 0 ? ChartSeries::Style::line : ChartSeries::Style::dashed;
      line.name = k == 0 ? "A" : "B";
      line.x = sensor.time;
      line.y = sensor.values[static_cast<std::size_t>(column)];
      for (double& y : line.y) y *= unit.factor;
      line.colour = k;
      chart.series.push_back(line);
    }
  return chart;
}

std::string table(const std::vector<std::string>& head, const Rows& rows, std::size_t numbers_from) {
  Rows all = {head};
  for (const auto& row : rows) {
    all.emplace_back();
    for (const std::string& cell : row) all.back().push_back(html_text(cell));
  }
  return html_table(all, numbers_from);
}

}  // namespace

std::string comparison_text(const RunComparison& c) {
  std::string out =
      "A  " + c.a.dir + "  " + c.a.status + "\nB  " + c.b.dir + "  " + c.b.status + "\n" + c.verdict + "\n";
  const auto part = [&](const std::string& title, const std::vector<std::string>& head, const Rows& rows) {
    if (rows.empty()) return;
    Rows all = {head};
    all.insert(all.end(), rows.begin(), rows.end());
    out += "\n" + title + "\n" + text_table(all);
  };
  part("provenance", {"what", "A", "B"}, given_rows(c.provenance));
  part("case", {"where", "A", "B"}, given_rows(c.given));
  const Rows figures = figure_rows(c), series = series_rows(c);
  part(alike(c.figures.size(), figures.size(), "figures"), {"figure", "A", "B", "B - A", "of A"}, figures);
  part(alike(c.series.size(), series.size(), "columns of series"),
       {"series", "largest difference", "of the largest value", "at s", "rows"}, series);
  for (const std::string& line : {lacking(c.only_a, "A"), lacking(c.only_b, "B")})
    if (!line.empty()) out += "\n" + line + "\n";
  return out;
}

std::string comparison_page(const RunComparison& c) {
  Page page("A and B");
  page.header("<h1>Two runs</h1><p>A: " + html_text(c.a.title) + " <code>" + html_text(c.a.dir) + "</code>, " +
              html_text(c.a.status) + "<br>B: " + html_text(c.b.title) + " <code>" + html_text(c.b.dir) + "</code>, " +
              html_text(c.b.status) + "</p><p><b>" + html_text(c.verdict) + "</b></p>");
  const std::string none = "<p>No difference.</p>";
  page.section("given", "What they were given", "Given",
               (c.provenance.empty() && c.given.empty() ? none : "") +
                   (c.provenance.empty() ? "" : table({"Provenance", "A", "B"}, given_rows(c.provenance), 3)) +
                   (c.given.empty() ? "" : table({"Place in the case", "A", "B"}, given_rows(c.given), 3)));
  const Rows figures = figure_rows(c);
  std::string lacks;
  for (const std::string& line : {lacking(c.only_a, "A"), lacking(c.only_b, "B")})
    if (!line.empty()) lacks += "<p>" + html_text(line) + "</p>";
  page.section("figures", "Figures", "Figures",
               "<p>" + alike(c.figures.size(), figures.size(), "figures") + ".</p>" + lacks +
                   (figures.empty() ? "" : table({"Figure", "A", "B", "B - A", "of A"}, figures, 1)));
  const Rows series = series_rows(c);
  std::string drawn;
  std::size_t count = 0;
  for (const SeriesDifference& s : c.series)
    if (!s.same && s.rows > 1 && count++ < kCharts) drawn += page.chart(overlay(c, s));
  page.section("series", "Series", "Series",
               "<p>" + alike(c.series.size(), series.size(), "columns") +
                   (count > kCharts ? "; the first " + std::to_string(kCharts) + " are drawn" : "") + ".</p>" +
                   (drawn.empty() ? "" : "<div class=\"charts\">" + drawn + "</div>") +
                   (series.empty()
                        ? ""
                        : table({"Column", "Largest difference", "of the largest value", "at, s", "rows"}, series, 1)));
  return page.html();
}

}  // namespace calx
