// What the simulation gets wrong: one row and one plot for each observable.
#include <algorithm>
#include <cmath>

#include "report/diagnosis_page_sections.hpp"
#include "report/diagnosis_page_words.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

using Style = ChartSeries::Style;

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) out.push_back(a[k] - b[k]);
  return out;
}

std::string conditions_html(const DiagnosisResult::Observable& o) {
  std::string out;
  for (const auto& [name, value] : o.conditions) {
    const Quantity q = quantity_of(name);
    out += (out.empty() ? "" : ", ") + html_text(q.title) + " " + html_text(value) +
           (q.unit.empty() ? "" : "\xc2\xa0" + html_text(q.unit));
  }
  return out;
}

std::string noise_html(const DiagnosisResult::Observable& o) {
  std::string out = o.noise_estimated ? "noise from repeats" : "noise as declared";
  if (o.repeats > 0) out += ", " + format_number(o.repeats) + (o.repeats > 1 ? " repeats" : " measurement");
  if (o.simulated_elsewhere) out += "; simulated figures from the study file";
  return out;
}

/// Fitted and held-out numbers in colours of their own, less the recalibrated simulation.
void add_measured(Chart& chart, const DiagnosisResult::Observable& o) {
  const std::vector<double> sd = o.sd.size() == o.x.size() ? o.sd : std::vector<double>();
  if (!o.fit.empty())
    chart.series.push_back({Style::points, "measured, fitted", o.x, difference(o.fit, o.before), sd, 1});
  if (!o.hold.empty())
    chart.series.push_back({Style::points, "measured, held out", o.x, difference(o.hold, o.before), sd, 3});
}

}  // namespace

Chart DiagnosisSections::curve_of(const DiagnosisResult::Observable& o) {
  Chart chart;
  chart.title = o.name;
  const Quantity x = quantity_of(o.against);
  chart.x.title = x.title.empty() ? "number" : x.title;
  chart.x.unit = x.unit;
  chart.x.logarithmic = o.log_x && std::all_of(o.x.begin(), o.x.end(), [](double v) { return v > 0; });
  chart.y.unit = o.unit == "1" ? "" : o.unit;
  return chart;
}

std::string DiagnosisSections::residual_chart(const DiagnosisResult::Observable& o) {
  Chart chart = curve_of(o);
  chart.y.title = "measured less simulated";
  const std::vector<double> zero(o.x.size(), 0.0);
  chart.series.push_back({Style::band, "recalibrated simulation", o.x, zero, o.band, 0});
  if (o.band.size() != o.x.size()) chart.series[0].style = Style::line, chart.series[0].error.clear();
  if (d.has_after() && o.after.size() == o.before.size())
    chart.series.push_back({Style::line, added(), o.x, difference(o.after, o.before), {}, 2});
  add_measured(chart, o);
  chart.caption =
      "The simulation gives " + error_html(o.signed_error, o.unit) + " on average. Chance? " + chance_html(o.p) + ".";
  return page.chart(chart);
}

/// Figures of one number each, side by side in units of what may part measurement and simulation by chance.
std::string DiagnosisSections::single_values_chart() {
  Chart chart;
  chart.title = "Single values";
  chart.x.title = "observable";
  chart.y.title = "measured less simulated / sd";
  std::vector<double> at, after, fit_at, fit, fit_error, hold_at, hold, hold_error;
  for (const DiagnosisResult::Observable& o : d.observables) {
    if (o.x.size() != 1 || o.before.empty()) continue;
    const double place = static_cast<double>(at.size());
    const double sd = o.sd.empty() ? 0 : o.sd[0], size = !o.band.empty() && o.band[0] > 0 ? o.band[0] : sd;
    if (!(size > 0)) continue;
    at.push_back(place);
    chart.x.categories.push_back(o.name);
    after.push_back(o.after.empty() ? DiagnosisResult::unknown : (o.after[0] - o.before[0]) / size);
    if (!o.fit.empty())
      fit_at.push_back(place - 0.1), fit.push_back((o.fit[0] - o.before[0]) / size), fit_error.push_back(sd / size);
    if (!o.hold.empty())
      hold_at.push_back(place + 0.1), hold.push_back((o.hold[0] - o.before[0]) / size), hold_error.push_back(sd / size);
  }
  if (at.empty()) return "";
  if (d.has_after()) chart.series.push_back({Style::points, added(), at, after, {}, 2});
  if (!fit.empty()) chart.series.push_back({Style::points, "measured, fitted", fit_at, fit, fit_error, 1});
  if (!hold.empty()) chart.series.push_back({Style::points, "measured, held out", hold_at, hold, hold_error, 3});
  // Last, for the first series says where the pointer is.
  const double end = static_cast<double>(at.size()) - 0.5;
  chart.series.push_back({Style::band, "recalibrated simulation", {-0.5, end}, {0, 0}, {1, 1}, 0});
  chart.caption = "In units of what chance may do, one standard deviation.";
  chart.wide = at.size() > 4;
  return page.chart(chart);
}

void DiagnosisSections::wrong() {
  if (d.observables.empty()) {
    page.section("wrong", "What is wrong", "What is wrong", html_absent("diagnosis.json holds no observables."));
    return;
  }
  std::string out =
      "<p>Before anything is blamed, the parameters that nobody knows exactly are set anew, so that the simulation "
      "comes as close to the measurements as they allow. The difference that is left:</p>";
  std::vector<std::vector<std::string>> rows = {
      {"Observable", "The simulation gives", "Could chance do that?", "Looks like", "z", "p"}};
  if (!d.named().empty()) rows[0].push_back("z with the cause");
  for (const DiagnosisResult::Observable& o : d.observables) {
    std::string name = "<b>" + html_text(o.name) + "</b><br><small>" + use_html(o) + ", " + noise_html(o);
    const std::string conditions = conditions_html(o);
    if (!conditions.empty()) name += "; " + conditions;
    const std::string mood = mood_of(o.p);
    rows.push_back({name + "</small>",
                    "<span class=\"" + mood + " said\">" + error_html(o.signed_error, o.unit) + "</span>",
                    chance_html(o.p), shape_html(o.looks_like), number_html(o.z, 2), number_html(o.p, 2)});
    if (!d.named().empty()) rows.back().push_back(number_html(o.z_after, 2));
  }
  out += html_table(rows, 4);
  if (std::isfinite(d.fit_p)) {
    out += "<p>All observables together: would chance alone give differences like these? <b>" + chance_html(d.fit_p) +
           "</b> (p = " + number_html(d.fit_p, 2) + ").";
    if (!d.named().empty() && std::isfinite(d.fit_p_with_named))
      out +=
          " With the cause: " + chance_html(d.fit_p_with_named) + " (p = " + number_html(d.fit_p_with_named, 2) + ").";
    out += "</p>";
  }
  out +=
      "<p class=\"note\">The error is simulation less measurement, averaged over the curve; z is that in its own "
      "standard deviations, so that beyond \xc2\xb1"
      "3 is much. Chance holds noise of the measurement, scatter between seeds, errors of the time step and the "
      "tolerance of the study; it looks at shapes too, so that a curve may be wrong although its average is right.</p>";
  for (const DiagnosisResult::Event& e : d.events)
    out += "<p class=\"note\">Odd value set aside: " + html_text(e.observable) + " at " + format_number(e.x, 4) + ", " +
           format_number(e.z, 2) + " standard deviations off.</p>";
  out +=
      "<h3>Measured less simulated</h3><p class=\"note\">Zero is the recalibrated simulation, the shade how far "
      "measurements may lie off by chance (one standard deviation). Dots above zero: the simulation gives too little; "
      "below: too much. Bars at dots: one standard deviation of the measurement.</p><div class=\"charts\">" +
      single_values_chart();
  for (const DiagnosisResult::Observable& o : d.observables)
    if (o.x.size() > 1 && !o.before.empty()) out += residual_chart(o);
  page.section("wrong", "1. What is wrong", "What is wrong", out + "</div>");
}

}  // namespace calx
