// Lab plots of flow and piles: discharge with its fitted rate, pile profile with its flanks and sectors, surface in a
// drum, and whether the bed moved quasi-statically. Drawn for sensors by their kind, whatever the case.
#include <algorithm>
#include <cmath>

#include "report/key_figures.hpp"
#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const std::string plus_minus = " \xc2\xb1 ", degree = "\xc2\xb0";

const CurveResult* curve_of(const RunFolder& run, const std::string& sensor, const std::string& name) {
  for (const auto& [owner, curve] : run.curves)
    if (owner == sensor && curve.name == name) return &curve;
  return nullptr;
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values)
    if (std::isfinite(v)) out = std::max(out, std::fabs(v));
  return out;
}

void add(Chart& chart, const CurveResult* curve, ChartSeries::Style style, const std::string& name, int colour,
         double factor_x, double factor_y) {
  if (!curve) return;
  ChartSeries series{style, name, curve->x, curve->y, {}, colour};
  for (double& x : series.x) x *= factor_x;
  for (double& y : series.y) y *= factor_y;
  chart.series.push_back(series);
}

std::string angle_text(double angle, double sd) {
  return format_number(angle, 3) + (std::isfinite(sd) ? plus_minus + format_number(sd, 2) : "") + degree;
}

std::string discharge_chart(Page& page, const RunFolder& run, const SensorSeries& s) {
  const CurveResult* mass = curve_of(run, s.name, "discharge");
  if (!mass) return html_absent("Sensor " + s.name + ": nothing was discharged yet.");
  const DisplayUnit unit = display_unit("kg", largest(mass->y));
  Chart chart;
  chart.title = s.name + ": mass discharged against time";
  chart.wide = true;
  chart.x = {"time", "s", false, {}};
  chart.y = {"mass discharged", unit.unit, true, {}};
  add(chart, mass, ChartSeries::Style::line, "discharged", 0, 1, unit.factor);
  add(chart, curve_of(run, s.name, "middle half"), ChartSeries::Style::line, "fitted rate", 1, 1, unit.factor);
  add(chart, curve_of(run, s.name, "Beverloo"), ChartSeries::Style::dashed, "Beverloo, same grains", 2, 1, unit.factor);
  const auto last = [&](const char* column) { return last_row(s, column); };
  chart.caption = format_quantity(last("mass_kg"), "kg") + " discharged, " +
                  format_quantity(last("retained_kg"), "kg") + " retained.";
  if (std::isfinite(last("rate_kg_s"))) {
    chart.caption += " Rate " + format_quantity(last("rate_kg_s"), "kg/s", 3) + plus_minus +
                     format_quantity(last("rate_sd_kg_s"), "kg/s", 3) + " (sd of ten spans), R<sup>2</sup> " +
                     format_number(last("r2_1"), 5) + ", longest pause " + format_quantity(last("pause_s"), "s", 3) +
                     ". Beverloo's estimate for grains of " + format_quantity(last("grain_m"), "m", 3) +
                     " at a bulk density of " + format_quantity(last("density_kg_m3"), "kg/m^3", 4) + ": " +
                     format_quantity(last("beverloo_kg_s"), "kg/s", 3) + ", ratio " +
                     format_number(last("ratio_1"), 3) + ".";
  }
  return page.chart(chart);
}

std::string pile_charts(Page& page, const RunFolder& run, const SensorSeries& s) {
  const CurveResult* profile = curve_of(run, s.name, "profile");
  if (!profile) return html_absent("Sensor " + s.name + ": no pile was seen yet.");
  const DisplayUnit unit = display_unit("m", std::max(largest(profile->x), largest(profile->y)));
  Chart chart;
  chart.title = s.name + ": profile and fitted flank";
  const Quantity along = quantity_of(profile->x_name);
  chart.x = {along.title, unit.unit, false, {}};
  chart.y = {"height", unit.unit, false, {}};
  chart.equal_scales = true;
  // Below the height 0 of the case an area down to 0 would lie above the pile.
  const bool above = std::none_of(profile->y.begin(), profile->y.end(), [](double y) { return y < 0; });
  chart.y.from_zero = above;
  add(chart, profile, above ? ChartSeries::Style::area : ChartSeries::Style::line, "profile", 2, unit.factor,
      unit.factor);
  for (const char* name : {"flank", "flank left", "flank right"})
    add(chart, curve_of(run, s.name, name), ChartSeries::Style::line, name, 1, unit.factor, unit.factor);
  const double angle = last_row(s, "angle_deg"), sd = last_row(s, "sd_deg");
  if (std::isfinite(angle)) {
    chart.caption = "Angle of repose " + angle_text(angle, sd) + " over " + format_number(last_row(s, "sectors_1")) +
                    " sectors and " + format_number(last_row(s, "bins_1")) + " bins.";
    const double check = last_row(s, "volume_angle_deg");
    if (std::isfinite(check))
      chart.caption += " Independent of any fit, from volume and base: " + format_number(check, 3) + degree + ".";
  } else {
    chart.caption =
        s.reason.empty() ? "No flank was found that gives an angle." : "No angle: " + html_text(s.reason) + ".";
  }
  chart.caption +=
      " Bins of one grain diameter, 95th percentile; lines through 20 to 80 % of the height. Both axes have the "
      "same scale.";
  std::string out = page.chart(chart);
  const CurveResult* sectors = curve_of(run, s.name, "sectors");
  if (!sectors || sectors->x.empty()) return out;
  const bool is_cone = sectors->x_name == "azimuth_deg";
  const DisplayUnit place = is_cone ? DisplayUnit{"deg", 1} : display_unit("m", largest(sectors->x));
  Chart each;
  each.title = s.name + (is_cone ? ": angle of each sector" : ": angle of each slice");
  each.x = {is_cone ? "azimuth" : "place along the ridge", place.unit, false, {}};
  each.y = {"angle", "deg", false, {}};
  add(each, sectors, ChartSeries::Style::points, "angle", 0, place.factor, 1);
  if (std::isfinite(angle)) each.bands.push_back({angle, std::isfinite(sd) ? sd : 0, "mean and sd"});
  each.caption = "An angle is not known finer than the scatter of its sectors.";
  return out + page.chart(each);
}

std::string drum_chart(Page& page, const RunFolder& run, const SensorSeries& s) {
  const CurveResult* surface = curve_of(run, s.name, "surface");
  if (!surface) return html_absent("Sensor " + s.name + ": no frame of the bed yet.");
  const CurveResult* wall = curve_of(run, s.name, "drum");
  const DisplayUnit unit = display_unit("m", wall ? largest(wall->x) : largest(surface->x));
  Chart chart;
  chart.title = s.name + ": free surface in the drum";
  chart.x = {"distance from the axis", unit.unit, false, {}};
  chart.y = {"height over the axis", unit.unit, false, {}};
  chart.equal_scales = true;
  add(chart, wall, ChartSeries::Style::line, "drum", 5, unit.factor, unit.factor);
  add(chart, surface, ChartSeries::Style::line, "surface", 0, unit.factor, unit.factor);
  add(chart, curve_of(run, s.name, "near line"), ChartSeries::Style::dashed, "line, near", 1, unit.factor, unit.factor);
  add(chart, curve_of(run, s.name, "far line"), ChartSeries::Style::dashed, "line, far", 2, unit.factor, unit.factor);
  const auto last = [&](const char* column) { return last_row(s, column); };
  chart.caption = "Dynamic angle " + format_number(last("angle_deg"), 3) + degree + " near the middle (rms " +
                  format_quantity(last("rms_m"), "m", 3) + "), " + format_number(last("far_deg"), 3) + degree +
                  " over the wider part (rms " + format_quantity(last("far_rms_m"), "m", 3) + "). Where half of " +
                  format_number(last("frames_1")) + " frames show grains; dark share " +
                  format_number(100 * last("fill_1"), 3) + "\xc2\xa0%.";
  return page.chart(chart);
}

std::string quasi_static(const SensorSeries& s) {
  const double number = last_row(s, "largest_1");
  if (!std::isfinite(number)) return html_absent("Sensor " + s.name + ": no inertial number yet.");
  // Bounds of GDR MiDi 2004 (Eur. Phys. J. E 14, 341).
  const char* const what = number < 1e-3 ? "quasi-static (below 0.001)"
                           : number < 0.1
                               ? "not quasi-static (above 0.001): the result may depend on the speed of the rig"
                               : "collisional (above 0.1)";
  return "<p><b>" + html_text(s.name) + "</b>: largest inertial number " + format_number(number, 2) + ", " + what +
         ".</p>";
}

}  // namespace

bool Sections::is_flow_kind(const std::string& kind) {
  return kind == "discharge" || kind == "angle-of-repose" || kind == "drum-surface" || kind == "inertial-number";
}

void Sections::flow() {
  std::string charts, notes;
  for (const SensorSeries& s : run.sensors) {
    if (s.kind == "discharge") charts += discharge_chart(page, run, s);
    if (s.kind == "angle-of-repose") charts += pile_charts(page, run, s);
    if (s.kind == "drum-surface") charts += drum_chart(page, run, s);
    if (s.kind == "inertial-number") notes += quasi_static(s);
  }
  if (!(charts + notes).empty())
    page.section("flow", "Flow and piles", "Flow", notes + "<div class=\"charts\">" + charts + "</div>");
}

}  // namespace calx
