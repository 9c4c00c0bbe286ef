#include "report/key_figures.hpp"

#include <algorithm>
#include <cctype>

#include "report/units.hpp"

namespace calx {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The vessel that is filled is called canister in the process; else the mass sensor listed first.
const SensorSeries* fill_sensor(const RunFolder& run) {
  const SensorSeries* first = nullptr;
  for (const SensorSeries& s : run.sensors) {
    if (s.kind != "mass") continue;
    if (lower(s.name).find("canister") != std::string::npos) return &s;
    if (!first) first = &s;
  }
  return first;
}

double energy_value(const RunFolder& run, const std::string& name) {
  const double stated = value_of(run.energy, name, nan);
  if (std::isfinite(stated)) return stated;
  const SensorSeries* sensor = run.sensor_of("energy");
  return sensor ? last_value(*sensor, name + "_J") : nan;
}

void close_ledger(const RunFolder& run, KeyFigures& out) {
  const SensorSeries* sensor = run.sensor_of("mass-ledger");
  const double imbalance = sensor ? last_value(*sensor, "imbalance_1") : nan;
  const double inserted = value_of(run.mass, "inserted_particles", nan),
               inside = value_of(run.mass, "inside_particles", nan), left = value_of(run.mass, "left_particles", nan);
  if (std::isfinite(inserted + inside + left)) {
    const bool closed = inserted - inside - left == 0;  // whole numbers
    out.ledger = closed ? KeyFigures::Closed::yes : KeyFigures::Closed::no;
    out.ledger_text = format_count(inserted) + " inserted = " + format_count(inside) + " inside + " +
                      format_count(left) + " left" + (closed ? "" : " does not hold");
  } else if (has_value(run.mass, "closes")) {
    out.ledger = value_of(run.mass, "closes", 0) != 0 ? KeyFigures::Closed::yes : KeyFigures::Closed::no;
    out.ledger_text = "as stated in summary.json";
  } else if (!std::isfinite(imbalance)) {
    return;
  }
  if (std::isfinite(imbalance)) {
    if (imbalance != 0) out.ledger = KeyFigures::Closed::no;
    if (out.ledger == KeyFigures::Closed::unknown) out.ledger = KeyFigures::Closed::yes;
    out.ledger_text += (out.ledger_text.empty() ? "" : "; ") + std::string("inserted - regions - elsewhere - lost = ") +
                       format_count(imbalance) + " particles";
  }
}

}  // namespace

double last_row(const SensorSeries& sensor, const std::string& column) {
  const int k = sensor.column(column);
  return k < 0 || sensor.time.empty() ? std::numeric_limits<double>::quiet_NaN()
                                      : sensor.values[static_cast<std::size_t>(k)].back();
}

double last_value(const SensorSeries& sensor, const std::string& column) {
  const int k = sensor.column(column);
  if (k >= 0) {
    const std::vector<double>& v = sensor.values[static_cast<std::size_t>(k)];
    for (std::size_t i = v.size(); i-- > 0;) {
      if (std::isfinite(v[i])) return v[i];
    }
  }
  return value_of(sensor.last, column, nan);
}

CycleFigures cycle_figures(const SensorSeries& sensor) {
  CycleFigures out;
  out.sensor = sensor.name;
  const int cycle = sensor.column("cycle_1"), each = sensor.column("mass_kg"), total = sensor.column("total_kg");
  if (cycle < 0 || each < 0) return out;
  const auto& cycles = sensor.values[static_cast<std::size_t>(cycle)];
  const auto& masses = sensor.values[static_cast<std::size_t>(each)];
  double sum = 0;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    // Rows between two cycles repeat the last one.
    if (!(cycles[i] > (out.cycle.empty() ? 0 : out.cycle.back())) || !std::isfinite(masses[i])) continue;
    sum += masses[i];
    out.cycle.push_back(cycles[i]);
    out.each.push_back(masses[i]);
    out.total.push_back(total >= 0 ? sensor.values[static_cast<std::size_t>(total)][i] : sum);
  }
  if (out.cycle.size() < 5) out.first = 1;
  std::vector<double> x, y, m;
  for (std::size_t i = 0; i < out.cycle.size(); ++i) {
    if (out.cycle[i] < out.first) continue;
    x.push_back(out.cycle[i]), y.push_back(out.total[i]), m.push_back(out.each[i]);
  }
  out.per_cycle = spread_of(m);
  out.line = fit_line(x, y);
  return out;
}

KeyFigures key_figures(const RunFolder& run) {
  KeyFigures out;
  out.fill = fill_sensor(run);
  if (out.fill) out.filled = last_value(*out.fill, "mass_kg");
  if (const SensorSeries* s = run.sensor_of("cycle-mass")) out.cycles = cycle_figures(*s);
  if (!std::isfinite(out.filled) && !out.cycles.total.empty()) out.filled = out.cycles.total.back();
  out.energy_remainder = energy_value(run, "remainder");
  out.energy_work = energy_value(run, "work_done");
  close_ledger(run, out);
  return out;
}

}  // namespace calx
