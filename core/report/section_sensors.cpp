// Dosing, pile, loads, and a chart for every other sensor series.
#include <algorithm>
#include <cmath>
#include <map>

#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

double largest(const std::vector<double>& values) {
  double out = 0;
  for (double v : values) {
    if (std::isfinite(v)) out = std::max(out, std::fabs(v));
  }
  return out;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

const std::vector<double>& column(const SensorSeries& s, int k) { return s.values[static_cast<std::size_t>(k)]; }

std::string grid(const std::string& charts) { return "<div class=\"charts\">" + charts + "</div>"; }

Chart against_time(const std::string& title, const std::string& quantity, const std::string& unit) {
  Chart chart;
  chart.title = title;
  chart.x = {"time", "s", false, {}};
  chart.y = {quantity, unit, false, {}};
  return chart;
}

// "centre x" and "centre z" have "centre" in common; "wall work" and "inserted" have nothing.
std::string common_words(const std::string& a, const std::string& b) {
  std::size_t same = 0;
  while (same < a.size() && same < b.size() && a[same] == b[same]) ++same;
  if (same == a.size() && (same == b.size() || b[same] == ' ')) return a;
  if (same == b.size() && a[same] == ' ') return b;
  const std::size_t blank = a.rfind(' ', same);
  return blank == std::string::npos || blank > same ? "" : a.substr(0, blank);
}

std::string quantity_name(const std::string& unit) {
  static const std::map<std::string, std::string> names = {
      {"N", "force"},  {"N m", "torque"}, {"J", "energy"},  {"W", "power"},   {"kg", "mass"},     {"kg/s", "mass flow"},
      {"m", "length"}, {"m/s", "speed"},  {"deg", "angle"}, {"rad", "angle"}, {"Pa", "pressure"}, {"s", "time"}};
  const auto at = names.find(unit);
  return at == names.end() ? "value" : at->second;
}

std::string sensor_caption(const SensorSeries& s) {
  return "Sensor " + html_text(s.name) + (s.kind.empty() ? "" : ", kind " + html_text(s.kind)) +
         (s.every > 0 ? ", every " + format_quantity(s.every, "s", 3) : "") + ".";
}

std::string cycle_charts(Page& page, const CycleFigures& c) {
  const DisplayUnit total_unit = display_unit("kg", largest(c.total)), each_unit = display_unit("kg", largest(c.each));
  Chart line;
  line.title = "Mass against cycle";
  line.x = {"cycle", "", true, {}};
  line.y = {"mass", total_unit.unit, true, {}};
  line.series.push_back(
      {ChartSeries::Style::points, "after each cycle", c.cycle, scaled(c.total, total_unit.factor), {}, 0});
  if (c.line.possible) {
    std::vector<double> ends = {0, c.cycle.back()}, at;
    for (double x : ends) at.push_back((c.line.intercept + c.line.slope * x) * total_unit.factor);
    line.series.push_back({ChartSeries::Style::dashed, "straight line", ends, at, {}, 1});
    line.caption = "Slope " + format_quantity(c.line.slope, "kg", 4) + " per cycle, intercept " +
                   format_quantity(c.line.intercept, "kg", 3) +
                   ", R<sup>2</sup> = " + format_number(c.line.r_squared, 6) + ", fitted to cycles " +
                   format_number(c.first) + " to " + format_number(c.cycle.back()) + ".";
  }
  Chart bars;
  bars.title = "Mass per cycle";
  bars.x = {"cycle", "", false, {}};
  bars.y = {"mass per cycle", each_unit.unit, true, {}};
  bars.series.push_back({ChartSeries::Style::bars, "mass per cycle", c.cycle, scaled(c.each, each_unit.factor), {}, 0});
  if (c.per_cycle.count > 1) {
    bars.bands.push_back(
        {c.per_cycle.mean * each_unit.factor, c.per_cycle.deviation * each_unit.factor, "mean and sd"});
    bars.caption = "Mean " + format_quantity(c.per_cycle.mean, "kg", 4) + ", sd " +
                   format_quantity(c.per_cycle.deviation, "kg", 3) + " (" +
                   format_number(100 * c.per_cycle.deviation / c.per_cycle.mean, 2) + "\xc2\xa0%) over " +
                   std::to_string(c.per_cycle.count) + " cycles, from cycle " + format_number(c.first) + " on.";
  }
  std::string out = page.chart(line) + page.chart(bars);
  if (c.per_cycle.count > 1) {
    Chart scatter = bars;
    scatter.title = "Scatter of the mass per cycle";
    scatter.y.from_zero = false;
    ChartSeries points{ChartSeries::Style::points, "mass per cycle", {}, {}, {}, 0};
    for (std::size_t k = 0; k < c.cycle.size(); ++k) {
      if (c.cycle[k] < c.first) continue;
      points.x.push_back(c.cycle[k]), points.y.push_back(c.each[k] * each_unit.factor);
    }
    scatter.series = {points};
    scatter.caption = "The same figures, axis not from zero. Line: mean; band: one standard deviation on either side.";
    out += page.chart(scatter);
  }
  return out;
}

}  // namespace

std::vector<ChartMark> Sections::event_marks() const {
  std::vector<ChartMark> out;
  for (const NamedValue& e : run.events) out.push_back({e.value, e.name});
  return out;
}

std::string Sections::sensor_charts(const SensorSeries& s, const std::set<std::string>& leave_out) {
  drawn.insert(s.name);
  if (s.time.empty()) return html_absent("Sensor " + s.name + ": " + (s.missing.empty() ? "no rows" : s.missing) + ".");
  // Columns of one unit share a chart; ratios and counts (no unit) get one each, as their sizes have nothing in common.
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::string, std::size_t> group_of;
  for (std::size_t k = 0; k < s.columns.size(); ++k) {
    if (leave_out.count(s.columns[k])) continue;
    const std::string unit = quantity_of(s.columns[k]).unit;
    const auto at = unit.empty() ? group_of.end() : group_of.find(unit);
    if (at != group_of.end() && groups[at->second].size() < 7) {
      groups[at->second].push_back(k);
    } else {
      if (!unit.empty()) group_of[unit] = groups.size();
      groups.push_back({k});
    }
  }
  std::string out;
  for (const std::vector<std::size_t>& group : groups) {
    const Quantity first = quantity_of(s.columns[group[0]]);
    double high = 0;
    for (std::size_t k : group) high = std::max(high, largest(s.values[k]));
    const DisplayUnit unit = display_unit(first.unit, high);
    std::string quantity = first.title;
    for (std::size_t k : group) quantity = common_words(quantity, quantity_of(s.columns[k]).title);
    if (quantity.empty()) quantity = quantity_name(first.unit);
    Chart chart = against_time(quantity == s.name ? s.name : s.name + ": " + quantity, quantity, unit.unit);
    bool empty = true;
    for (std::size_t k : group) {
      for (double v : s.values[k]) empty = empty && !std::isfinite(v);
      chart.series.push_back({ChartSeries::Style::line,
                              quantity_of(s.columns[k]).title,
                              s.time,
                              scaled(s.values[k], unit.factor),
                              {},
                              -1});
    }
    chart.caption = sensor_caption(s);
    if (empty) chart.caption += " No value yet: every row of this column is empty.";
    out += page.chart(chart);
  }
  return out;
}

std::string Sections::without_sensor(const std::string& sentence) const {
  const bool rig = std::any_of(run.sensors.begin(), run.sensors.end(),
                               [](const SensorSeries& s) { return is_flow_kind(s.kind) || is_lab_kind(s.kind); });
  return rig ? "" : html_absent(sentence);
}

void Sections::dosing() {
  std::string out;
  if (figures.fill && !figures.fill->time.empty() && figures.fill->column("mass_kg") >= 0) {
    const std::vector<double>& mass = column(*figures.fill, figures.fill->column("mass_kg"));
    const DisplayUnit unit = display_unit("kg", largest(mass));
    Chart chart = against_time(figures.fill->name + " against time", "mass", unit.unit);
    chart.wide = true;
    chart.y.from_zero = true;
    chart.series.push_back(
        {ChartSeries::Style::area, figures.fill->name, figures.fill->time, scaled(mass, unit.factor), {}, 0});
    chart.marks = event_marks();
    chart.caption = sensor_caption(*figures.fill) + (chart.marks.empty() ? "" : " Dashed: events of the case.");
    out += page.chart(chart);
  } else {
    out += figures.fill ? html_absent("No mass against time: " + figures.fill->missing + ".")
                        : without_sensor("No mass against time: the case has no sensor of kind mass.");
  }
  if (!figures.cycles.cycle.empty()) {
    out += cycle_charts(page, figures.cycles);
  } else {
    const SensorSeries* s = run.sensor_of("cycle-mass");
    out +=
        !s ? without_sensor("No masses per cycle: the case has no sensor of kind cycle-mass.")
           : html_absent(s->time.empty() ? "No masses per cycle: " + s->missing + "." : "No cycle is completed yet.");
  }
  if (const SensorSeries* s = run.sensor_of("cycle-mass")) drawn.insert(s->name);
  for (const SensorSeries& s : run.sensors) {
    if (s.kind == "flow") out += sensor_charts(s, {"particles_1"});
  }
  if (out.empty()) return;
  page.section(
      "dosing", "Dosing", "Dosing",
      "<p class=\"note screen\">Drag across a chart to enlarge that stretch; a double click shows all of it.</p>" +
          grid(out));
}

void Sections::pile() {
  std::string out;
  for (const auto& [sensor, field] : run.fields) {
    const double high = std::max({largest(field.values), std::fabs(field.origin.x), std::fabs(field.origin.y)});
    const DisplayUnit length = display_unit("m", high), unit = display_unit(field.unit, largest(field.values));
    Chart map;
    map.kind = Chart::Kind::map;
    map.title = sensor + ": " + field.name + " seen from above";
    map.x = {"x", length.unit, false, {}};
    map.y = {"y", length.unit, false, {}};
    map.value = {field.name, unit.unit, false, {}};
    map.equal_scales = true;
    map.nx = field.nx, map.ny = field.ny;
    map.x0 = field.origin.x * length.factor, map.y0 = field.origin.y * length.factor,
    map.cell = field.cell * length.factor;
    map.values = scaled(field.values, unit.factor);
    map.caption =
        "At the end of the run, cells of " + format_quantity(field.cell, "m", 3) + "; empty where nothing lies.";
    out += page.chart(map);
  }
  for (const auto& [sensor, curve] : run.curves) {
    const SensorSeries* s = nullptr;
    for (const SensorSeries& one : run.sensors) s = one.name == sensor ? &one : s;
    if (s && (s->kind == "cycle-mass" || is_flow_kind(s->kind))) continue;  // drawn under Dosing or Flow
    const Quantity x = quantity_of(curve.x_name), y = quantity_of(curve.y_name);
    const bool lengths = x.unit == "m" && y.unit == "m";
    const double high_x = largest(curve.x), high_y = largest(curve.y);
    const DisplayUnit ux = display_unit(x.unit, lengths ? std::max(high_x, high_y) : high_x);
    const DisplayUnit uy = display_unit(y.unit, lengths ? std::max(high_x, high_y) : high_y);
    Chart chart;
    chart.title = sensor + ": " + curve.name;
    chart.x = {x.title, ux.unit, false, {}};
    chart.y = {y.title, uy.unit, lengths, {}};
    chart.equal_scales = lengths;
    chart.series.push_back({lengths ? ChartSeries::Style::area : ChartSeries::Style::line,
                            curve.name,
                            scaled(curve.x, ux.factor),
                            scaled(curve.y, uy.factor),
                            {},
                            lengths ? 2 : 0});
    if (lengths) chart.caption = "Both axes have the same scale: angles are true.";
    out += page.chart(chart);
  }
  for (const SensorSeries& s : run.sensors) {
    if (s.kind != "angle-of-repose") continue;
    Chart chart;
    chart.title = s.name + ": angle of repose";
    chart.x = {"side", "", false, {"left", "all", "right"}};
    chart.y = {"angle", "deg", false, {}};
    ChartSeries points{ChartSeries::Style::points, "angle", {}, {}, {}, 0};
    const char* const names[3][2] = {
        {"left_deg", "left_sd_deg"}, {"angle_deg", "sd_deg"}, {"right_deg", "right_sd_deg"}};
    for (int k = 0; k < 3; ++k) {
      const double angle = last_value(s, names[k][0]), sd = last_value(s, names[k][1]);
      if (!std::isfinite(angle)) continue;
      points.x.push_back(k), points.y.push_back(angle), points.error.push_back(std::isfinite(sd) ? sd : 0);
      chart.caption += (chart.caption.empty() ? "" : ", ") + chart.x.categories[static_cast<std::size_t>(k)] + " " +
                       format_number(angle, 3) + (std::isfinite(sd) ? " \xc2\xb1 " + format_number(sd, 2) : "") +
                       "\xc2\xb0";
    }
    if (points.x.empty()) {
      out += html_absent("Sensor " + s.name + " found no flank that gives an angle of repose.");
    } else {
      chart.caption += ". Bars: one standard deviation over the sectors. An angle is not known finer than that.";
      chart.series.push_back(points);
      out += page.chart(chart);
    }
    out += sensor_charts(s, {"sectors_1", "bins_1", "sd_deg", "left_sd_deg", "right_sd_deg"});
  }
  if (out.empty()) {
    out = without_sensor(
        "No pile: the case has no sensor of kind height-map or angle-of-repose, or none has given a result yet.");
  }
  if (!out.empty()) page.section("pile", "Pile", "Pile", grid(out));
}

void Sections::loads() {
  std::string out;
  for (const SensorSeries& s : run.sensors) {
    if (s.kind == "part-load") out += sensor_charts(s);
  }
  if (out.empty()) out = without_sensor("No loads on parts: the case has no sensor of kind part-load.");
  if (!out.empty()) page.section("loads", "Loads on parts", "Loads", grid(out));
}

void Sections::other_sensors() {
  std::string out;
  // The main mass sensor and the ledgers have one chart each above; their other columns come here.
  for (const SensorSeries& s : run.sensors) {
    if (drawn.count(s.name)) continue;
    out += &s == figures.fill ? sensor_charts(s, {"mass_kg"}) : sensor_charts(s);
  }
  if (!out.empty()) page.section("sensors", "All other sensors", "Sensors", grid(out));
}

}  // namespace calx
