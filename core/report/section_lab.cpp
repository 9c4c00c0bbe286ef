// section_lab.cpp: the plots a powder laboratory draws, one group for each sensor of a kind that has one: density
// against stress or taps, wall yield locus, yield locus with its stress circles, flow function.
#include <algorithm>
#include <cmath>
#include <limits>

#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;
/// Above it grains are no longer sheared quasi-statically (GDR MiDi 2004, Eur. Phys. J. E 14, 341).
constexpr double inertial_limit = 1e-3;

/// A sensor's rows without those that repeat the last step; before them that of a bed as poured, where there is one.
class StepRows {
 public:
  explicit StepRows(const SensorSeries& s) : series_(s) {
    const int step = s.column("step_1");
    double last = 0;
    for (std::size_t k = 0; step >= 0 && k < s.time.size(); ++k) {
      const double now = s.values[static_cast<std::size_t>(step)][k];
      const int density = s.column("density_kg_m3");
      if (now == 0 && rows_.empty() && density >= 0 && std::isfinite(s.values[static_cast<std::size_t>(density)][k]))
        rows_.push_back(k);
      if (!(now > last)) continue;
      last = now;
      rows_.push_back(k);
    }
  }
  std::size_t count() const { return rows_.size(); }
  double at(const char* column, std::size_t row) const {
    const int k = series_.column(column);
    return k < 0 ? nan : series_.values[static_cast<std::size_t>(k)][rows_[row]];
  }
  double largest(const char* column) const {
    double out = nan;
    for (std::size_t k = 0; k < count(); ++k)
      if (!(at(column, k) <= out)) out = std::isfinite(at(column, k)) ? at(column, k) : out;
    return out;
  }

 private:
  const SensorSeries& series_;
  std::vector<std::size_t> rows_;
};

std::string plus_minus(double value, double error, const std::string& unit, int digits) {
  return format_number(value, digits) + (std::isfinite(error) ? " \xc2\xb1 " + format_number(error, 2) : "") +
         (unit.empty() ? "" : "\xc2\xa0" + unit);
}

std::string inertial_text(const StepRows& rows) {
  const double most = rows.largest("inertial_1");
  if (!std::isfinite(most)) return "";
  return " Largest inertial number " + format_number(most, 2) + (most < inertial_limit ? ", below" : ", <b>above</b>") +
         " the limit of " + format_number(inertial_limit) + " for quasi-static shear.";
}

/// level: of a yield locus; 0: no levels.
std::string unsteady_text(const StepRows& rows, const char* what, double level = 0) {
  std::size_t unsteady = 0, of = 0;
  for (std::size_t k = 0; k < rows.count(); ++k) {
    // The drift of a pre-shear stands in the rows that follow it, too.
    const bool counts = level == 0 || (rows.at("role_1", k) == 1 && rows.at("level_1", k) == level);
    if (!counts) continue;
    ++of;
    unsteady += rows.at("steady_1", k) == 0;
  }
  if (unsteady == 0) return "";
  return " <b>" + std::to_string(unsteady) + " of " + std::to_string(of) + " " + what + " had not become steady.</b>";
}

ChartSeries line_through(const std::string& name, double slope, double intercept, double to, int colour) {
  return {ChartSeries::Style::dashed, name, {0, to}, {intercept, intercept + slope * to}, {}, colour};
}

/// Upper half of the circle of principal stresses; kPa.
ChartSeries circle(const std::string& name, double from, double to, int colour) {
  ChartSeries out{ChartSeries::Style::line, name, {}, {}, {}, colour};
  for (int k = 0; k <= 90; ++k) {
    const double angle = pi * (1 - k / 90.0);
    out.x.push_back(0.5 * (from + to) + 0.5 * (to - from) * std::cos(angle));
    out.y.push_back(0.5 * (to - from) * std::sin(angle));
  }
  return out;
}

Chart stress_plane(const std::string& title) {
  Chart chart;
  chart.title = title;
  chart.x = {"normal stress", "kPa", true, {}};
  chart.y = {"shear stress", "kPa", true, {}};
  chart.equal_scales = true;
  chart.wide = true;
  return chart;
}

/// Loading up to the largest stress, unloading from there on.
Chart compression_chart(const SensorSeries& s, const StepRows& rows, const char* column, const std::string& quantity,
                        const std::string& unit) {
  Chart chart;
  chart.title = s.name + ": " + quantity + " against stress";
  chart.x = {"normal stress", "kPa", false, {}, true};
  chart.y = {quantity, unit, false, {}};
  ChartSeries up{ChartSeries::Style::line, "loading", {}, {}, {}, 0},
      down{ChartSeries::Style::line, "unloading", {}, {}, {}, 1},
      dots{ChartSeries::Style::points, "ends of steps", {}, {}, {}, 2};
  std::size_t top = 0;
  for (std::size_t k = 0; k < rows.count(); ++k)
    if (rows.at("stress_Pa", k) > rows.at("stress_Pa", top)) top = k;
  for (std::size_t k = 0; k < rows.count(); ++k) {
    const double stress = rows.at("stress_Pa", k) * 1e-3, value = rows.at(column, k);
    if (!(stress > 0) || !std::isfinite(value)) continue;
    dots.x.push_back(stress), dots.y.push_back(value);
    if (k <= top) up.x.push_back(stress), up.y.push_back(value);
    // Readers of charts look for the nearest x by bisection, so x must rise.
    if (k >= top) down.x.insert(down.x.begin(), stress), down.y.insert(down.y.begin(), value);
  }
  chart.series.push_back(up);
  if (down.x.size() > 1) chart.series.push_back(down);
  chart.series.push_back(dots);
  return chart;
}

std::string compression(Page& page, const SensorSeries& s, const StepRows& rows) {
  Chart density = compression_chart(s, rows, "density_kg_m3", "bulk density", "kg/m3");
  Chart cps = compression_chart(s, rows, "cps_percent", "compressibility (CPS)", "%");
  std::size_t top = 0;
  for (std::size_t k = 0; k < rows.count(); ++k)
    if (rows.at("stress_Pa", k) > rows.at("stress_Pa", top)) top = k;
  const std::size_t last = rows.count() - 1;
  density.caption = "From " + format_number(rows.at("density_kg_m3", 0), 4) + " to " +
                    format_number(rows.at("density_kg_m3", top), 4) + "\xc2\xa0kg/m<sup>3</sup> at " +
                    format_quantity(rows.at("stress_Pa", top), "Pa", 4) + ". Mass over area times height of the cell.";
  cps.caption = "100 (V<sub>0</sub> - V) / V<sub>0</sub>, V<sub>0</sub> at the end of the first step; " +
                format_number(rows.at("cps_percent", top), 3) + "\xc2\xa0% at " +
                format_quantity(rows.at("stress_Pa", top), "Pa", 4);
  if (last > top && rows.at("cps_percent", top) > 0)
    cps.caption += ", of which " +
                   format_number(100 * (1 - rows.at("cps_percent", last) / rows.at("cps_percent", top)), 3) +
                   "\xc2\xa0% come back on unloading to " + format_quantity(rows.at("stress_Pa", last), "Pa", 4);
  cps.caption += "." + inertial_text(rows);
  return page.chart(density) + page.chart(cps);
}

std::string tapping(Page& page, const SensorSeries& s, const StepRows& rows) {
  Chart chart;
  chart.title = s.name + ": bulk density against taps";
  chart.x = {"taps", "", false, {}};
  chart.y = {"bulk density", "kg/m3", false, {}};
  ChartSeries line{ChartSeries::Style::line, "bulk density", {}, {}, {}, 0};
  for (std::size_t k = 0; k < rows.count(); ++k)
    line.x.push_back(rows.at("step_1", k)), line.y.push_back(rows.at("density_kg_m3", k));
  chart.series.push_back(line);
  const double first = line.y.front(), last = line.y.back();
  chart.caption = "From " + format_number(first, 4) + (line.x.front() == 0 ? " as poured" : " after the first tap") +
                  " to " + format_number(last, 4) + "\xc2\xa0kg/m<sup>3</sup> after " + format_number(line.x.back()) +
                  " taps: Hausner ratio " + format_number(last / first, 4) + ", Carr index " +
                  format_number(100 * (1 - first / last), 3) +
                  "\xc2\xa0%. Height from the upper envelope of the particles.";
  return page.chart(chart);
}

std::string wall_locus(Page& page, const SensorSeries& s, const StepRows& rows) {
  Chart chart = stress_plane(s.name + ": wall yield locus");
  ChartSeries steady{ChartSeries::Style::points, "steady", {}, {}, {}, 0},
      moving{ChartSeries::Style::points, "not steady, not in the line", {}, {}, {}, 6};
  double most = 0;
  for (std::size_t k = 0; k < rows.count(); ++k) {
    ChartSeries& to = rows.at("steady_1", k) != 0 ? steady : moving;
    to.x.push_back(rows.at("normal_Pa", k) * 1e-3);
    to.y.push_back(rows.at("shear_Pa", k) * 1e-3);
    most = std::max(most, to.x.back());
  }
  const std::size_t last = rows.count() - 1;
  const double angle = rows.at("phi_w_deg", last), adhesion = rows.at("adhesion_Pa", last);
  chart.series.push_back(steady);
  if (!moving.x.empty()) chart.series.push_back(moving);
  if (std::isfinite(angle)) {
    chart.series.push_back(
        line_through("wall yield locus", std::tan(angle * pi / 180), adhesion * 1e-3, 1.05 * most, 1));
    chart.caption = "Angle of wall friction " + plus_minus(angle, rows.at("phi_w_se_deg", last), "\xc2\xb0", 4) +
                    ", adhesion " + plus_minus(adhesion, rows.at("adhesion_se_Pa", last), "Pa", 3) +
                    " (line with standard errors). ";
  }
  chart.caption += "Both axes have the same scale." + inertial_text(rows) + unsteady_text(rows, "steps");
  Chart each;
  each.title = s.name + ": angle against stress";
  each.x = {"normal stress", "kPa", false, {}};
  each.y = {"arctan(shear / normal)", "deg", false, {}};
  ChartSeries dots{ChartSeries::Style::points, "angle of wall friction", {}, {}, {}, 0};
  for (std::size_t k = rows.count(); k-- > 0;)
    dots.x.push_back(rows.at("normal_Pa", k) * 1e-3), dots.y.push_back(rows.at("angle_deg", k));
  each.series.push_back(dots);
  each.caption = "An adhesive wall gives an angle that falls with stress.";
  return page.chart(chart) + page.chart(each);
}

std::string yield_locus(Page& page, const SensorSeries& s, const StepRows& rows) {
  std::string out;
  ChartSeries function{ChartSeries::Style::points, "flow function", {}, {}, {}, 0};
  std::string text;
  const double levels = rows.largest("level_1");
  for (double level = 1; level <= levels; ++level) {
    Chart chart = stress_plane(s.name + ": yield locus" + (levels > 1 ? " " + format_number(level) : ""));
    ChartSeries pre{ChartSeries::Style::points, "pre-shear", {}, {}, {}, 2},
        yields{ChartSeries::Style::points, "shear to failure, prorated", {}, {}, {}, 0};
    std::size_t last = 0;
    for (std::size_t k = 0; k < rows.count(); ++k) {
      if (rows.at("level_1", k) != level) continue;
      last = k;
      const double normal = rows.at("normal_Pa", k) * 1e-3;
      if (rows.at("role_1", k) == 1) pre.x.push_back(normal), pre.y.push_back(rows.at("shear_Pa", k) * 1e-3);
      if (rows.at("role_1", k) == 2) yields.x.push_back(normal), yields.y.push_back(rows.at("prorated_Pa", k) * 1e-3);
    }
    chart.series = {yields, pre};
    const double phi = rows.at("phi_deg", last), cohesion = rows.at("cohesion_Pa", last);
    const double sigma1 = rows.at("sigma1_Pa", last), sigma3 = rows.at("sigma3_Pa", last),
                 strength = rows.at("strength_Pa", last);
    if (std::isfinite(phi) && std::isfinite(sigma1)) {
      chart.series.push_back(
          line_through("yield locus", std::tan(phi * pi / 180), cohesion * 1e-3, 0.5e-3 * (sigma1 + sigma3), 0));
      chart.series.push_back(circle("steady flow", sigma3 * 1e-3, sigma1 * 1e-3, 1));
      if (strength > 0) chart.series.push_back(circle("unconfined yield", 0, strength * 1e-3, 6));
      chart.series.push_back(line_through("effective yield locus", std::tan(rows.at("effective_deg", last) * pi / 180),
                                          0, 0.5e-3 * (sigma1 + sigma3), 3));
      chart.caption = "Internal friction " + plus_minus(phi, rows.at("phi_se_deg", last), "\xc2\xb0", 4) +
                      ", cohesion " + plus_minus(cohesion, rows.at("cohesion_se_Pa", last), "Pa", 4) +
                      " (line with standard errors); effective angle " +
                      format_number(rows.at("effective_deg", last), 3) + "\xc2\xb0, steady flow " +
                      format_number(rows.at("steady_deg", last), 3) + "\xc2\xb0; largest principal stress " +
                      format_quantity(sigma1, "Pa", 4) + ", unconfined strength " + format_quantity(strength, "Pa", 4) +
                      (strength > 0 ? ", ff<sub>c</sub> " + format_number(rows.at("ffc_1", last), 3)
                                    : ": not above 0, a powder without cohesion") +
                      ". ";
      function.x.push_back(sigma1 * 1e-3), function.y.push_back(strength * 1e-3);
    } else {
      chart.caption = "No locus yet: it needs two yield points at different stresses. ";
    }
    chart.caption += "Both axes have the same scale." + inertial_text(rows) + unsteady_text(rows, "pre-shears", level);
    out += page.chart(chart);
  }
  if (function.x.empty()) return out;
  Chart chart;
  chart.title = s.name + ": flow function";
  chart.x = {"largest principal stress", "kPa", true, {}};
  chart.y = {"unconfined strength", "kPa", true, {}};
  const double most = 1.2 * *std::max_element(function.x.begin(), function.x.end());
  chart.series.push_back(function);
  int colour = 1;
  for (const double ffc : {1.0, 2.0, 4.0, 10.0})
    chart.series.push_back(line_through("ff_c = " + format_number(ffc), 1 / ffc, 0, most, colour++));
  chart.caption =
      "One point for each level of pre-shear. ff<sub>c</sub> = stress / strength: above 10 a powder flows freely, from "
      "4 "
      "easily, from 2 it is cohesive, below very cohesive (Jenike's classes).";
  return out + page.chart(chart);
}

}  // namespace

bool Sections::is_lab_kind(const std::string& kind) {
  return kind == "cell-density" || kind == "wall-friction" || kind == "yield-locus";
}

void Sections::lab() {
  std::string out;
  for (const SensorSeries& s : run.sensors) {
    if (!is_lab_kind(s.kind)) continue;
    drawn.insert(s.name);
    const StepRows rows(s);
    if (rows.count() == 0)
      out += html_absent("Sensor " + s.name + ", kind " + s.kind + ": no step of its motion has ended yet.");
    else if (s.kind == "wall-friction")
      out += wall_locus(page, s, rows);
    else if (s.kind == "yield-locus")
      out += yield_locus(page, s, rows);
    else
      out += std::isfinite(rows.at("stress_Pa", 0)) ? compression(page, s, rows) : tapping(page, s, rows);
  }
  if (!out.empty()) page.section("lab", "Laboratory plots", "Laboratory", "<div class=\"charts\">" + out + "</div>");
}

}  // namespace calx
