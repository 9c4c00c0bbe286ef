// Energy and mass: where they came from and where they are.
#include <algorithm>
#include <cmath>

#include "report/sections.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

struct EnergyTerm {
  const char *column, *name;
};
// What the energy brought in has become. Gravity energy stands on an arbitrary zero, so its change is drawn.
const EnergyTerm energy_terms[] = {{"gravity_J", "gravity (change)"},
                                   {"kinetic_translation_J", "kinetic, translation"},
                                   {"kinetic_rotation_J", "kinetic, rotation"},
                                   {"elastic_J", "elastic"},
                                   {"friction_J", "lost in friction"},
                                   {"damping_J", "lost in damping"},
                                   {"plastic_J", "plastic work"}};

double largest(const std::vector<double>& values) {
  double out = 0;
  for (double v : values) {
    if (std::isfinite(v)) out = std::max(out, std::fabs(v));
  }
  return out;
}

std::string energy_charts(Page& page, const SensorSeries& s, const std::vector<ChartMark>& marks) {
  double high = 0;
  std::vector<std::vector<double>> terms;
  std::vector<std::string> names;
  for (const EnergyTerm& term : energy_terms) {
    const int k = s.column(term.column);
    if (k < 0) continue;
    std::vector<double> v = s.values[static_cast<std::size_t>(k)];
    if (v.empty() || !std::isfinite(v.front())) continue;
    if (std::string(term.column) == "gravity_J") {
      const double zero = v.front();
      for (double& e : v) e -= zero;
    }
    if (largest(v) == 0) continue;
    high = std::max(high, largest(v));
    terms.push_back(v);
    names.push_back(term.name);
  }
  if (terms.empty())
    return html_absent("Sensor " + s.name + ": no energy in its rows; the run keeps no energy ledger.");
  const DisplayUnit unit = display_unit("J", high);
  Chart stack;
  stack.kind = Chart::Kind::stack;
  stack.wide = true;
  stack.title = "Energy ledger";
  stack.x = {"time", "s", false, {}};
  stack.y = {"energy", unit.unit, false, {}};
  for (std::size_t k = 0; k < terms.size(); ++k) {
    for (double& v : terms[k]) v *= unit.factor;
    stack.series.push_back({ChartSeries::Style::area, names[k], s.time, terms[k], {}, static_cast<int>(k)});
  }
  stack.marks = marks;
  stack.caption =
      "What the energy of the grains has become; losses add up over the run, gravity is counted from the first row.";
  std::string out = page.chart(stack);

  const int k = s.column("remainder_J"), work = s.column("work_done_J");
  if (k >= 0) {
    std::vector<double> v = s.values[static_cast<std::size_t>(k)];
    const DisplayUnit small = display_unit("J", largest(v));
    for (double& e : v) e *= small.factor;
    Chart chart;
    chart.title = "Energy remainder";
    chart.x = {"time", "s", false, {}};
    chart.y = {"remainder", small.unit, true, {}};
    chart.series.push_back({ChartSeries::Style::line, "remainder", s.time, v, {}, 6});
    chart.caption = "Brought in minus accounted for: what time integration lost or gained.";
    out += page.chart(chart);
    if (work >= 0) {
      Chart share;
      share.title = "Energy remainder as a share of the work done";
      share.x = {"time", "s", false, {}};
      share.y = {"share", "%", true, {}};
      std::vector<double> ratio;
      for (std::size_t i = 0; i < s.time.size(); ++i) {
        const double w = s.values[static_cast<std::size_t>(work)][i];
        ratio.push_back(w > 0 ? 100 * std::fabs(s.values[static_cast<std::size_t>(k)][i]) / w : 0);
      }
      share.series.push_back({ChartSeries::Style::line, "share", s.time, ratio, {}, 6});
      out += page.chart(share);
    }
  }
  return out;
}

std::string words(const std::string& name) {
  const Quantity q = quantity_of(name);
  return q.title;
}

// Rows of name, count, mass from pairs of columns "<name>_1" and "<name>_kg".
std::string ledger_table(const SensorSeries& s) {
  std::vector<std::vector<std::string>> rows = {{"Where", "Particles", "Mass"}};
  for (const std::string& column : s.columns) {
    const std::size_t end = column.rfind("_kg");
    if (end == std::string::npos || end + 3 != column.size()) continue;
    const std::string name = column.substr(0, end);
    const double count = last_value(s, name + "_1"), mass = last_value(s, column);
    rows.push_back(
        {html_text(words(name)), std::isfinite(count) ? format_count(count) : "", format_quantity(mass, "kg", 5)});
  }
  const double imbalance = last_value(s, "imbalance_1");
  if (std::isfinite(imbalance)) rows.push_back({"<b>imbalance</b>", "<b>" + format_count(imbalance) + "</b>", ""});
  return rows.size() > 1 ? html_table(rows, 1) : "";
}

// summary.json's ledger: "inserted" with "inserted_particles" beside it.
std::string ledger_table(std::vector<NamedValue> mass) {
  std::vector<std::vector<std::string>> rows = {{"Where", "Particles", "Mass"}};
  // In the order of a balance: what was asked for, what came, where it is, what left; then everything else.
  const std::vector<std::string> order = {"requested", "delivered", "inserted", "inside", "left", "lost"};
  const auto rank = [&](const NamedValue& v) { return std::find(order.begin(), order.end(), v.name) - order.begin(); };
  std::stable_sort(mass.begin(), mass.end(),
                   [&](const NamedValue& a, const NamedValue& b) { return rank(a) < rank(b); });
  for (const NamedValue& v : mass) {
    const std::string count_of = "_particles";
    const bool is_count = v.name.size() > count_of.size() &&
                          v.name.compare(v.name.size() - count_of.size(), count_of.size(), count_of) == 0;
    if (is_count || v.name == "closes") continue;
    const double count = value_of(mass, v.name + count_of, std::nan(""));
    std::string name = v.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    rows.push_back(
        {html_text(name), std::isfinite(count) ? format_count(count) : "", format_quantity(v.value, "kg", 5)});
  }
  return rows.size() > 1 ? html_table(rows, 1) : "";
}

}  // namespace

void Sections::ledgers() {
  std::string charts;
  const SensorSeries* energy = run.sensor_of("energy");
  if (energy && !energy->time.empty()) {
    drawn.insert(energy->name);
    charts += energy_charts(page, *energy, event_marks());
    charts += sensor_charts(*energy, {"kinetic_translation_J", "kinetic_rotation_J", "gravity_J", "elastic_J",
                                      "friction_J", "damping_J", "plastic_J", "remainder_J", "remainder_share_1"});
  } else {
    charts += html_absent(energy ? "No energy ledger: " + energy->missing + "."
                                 : "No energy ledger: the case has no sensor of kind energy.");
  }
  const SensorSeries* mass = run.sensor_of("mass-ledger");
  if (mass && !mass->time.empty()) {
    // Counts tell the same as masses, but for the imbalance, which is exact.
    std::set<std::string> counts;
    for (const std::string& column : mass->columns) {
      if (quantity_of(column).unit.empty() && column != "imbalance_1") counts.insert(column);
    }
    charts += sensor_charts(*mass, counts);
  }
  std::string tables;
  const std::string summary = ledger_table(run.mass);
  if (!summary.empty())
    tables += "<div class=\"box\"><h3>Mass ledger of the run</h3>" + summary + "<p>" + html_text(figures.ledger_text) +
              "</p></div>";
  if (mass) {
    const std::string table = ledger_table(*mass);
    if (!table.empty())
      tables += "<div class=\"box\"><h3>Mass ledger by region</h3>" + table + "<p>Last row of sensor " +
                html_text(mass->name) + ".</p></div>";
  }
  if (tables.empty())
    tables = html_absent("No mass ledger: summary.json holds none and the case has no sensor of kind mass-ledger.");
  page.section("ledgers", "Energy and mass ledgers", "Ledgers",
               "<div class=\"charts\">" + charts + "</div><div class=\"two\">" + tables + "</div>");
}

}  // namespace calx
