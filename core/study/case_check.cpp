#include "study/case_check.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "sim/simulation.hpp"
#include "study/resolve.hpp"

namespace calx {
namespace {

/// What can be read from a sensor. curves: names of x and y.
struct Columns {
  std::string sensor;
  std::vector<std::string> columns;
  std::vector<std::pair<std::string, std::string>> curves;
  std::vector<std::string> fields;
};

[[noreturn]] void fail(const Study& study, const std::string& pointer, const std::string& what) {
  throw Error(Fault::settings, study.file + " " + pointer + ": " + what);
}

std::vector<Columns> sensors_of(const RunRequest& request, const std::vector<std::string>& plugin_path) {
  SimulationOptions options;
  options.threads = 1;
  options.device = "cpu";
  options.plugin_path = plugin_path;
  Simulation sim(resolve(request, plugin_path), options);
  std::vector<Columns> out;
  for (const auto& s : sim.sensors()) {
    out.push_back({s->name(), s->columns(), {}, {}});
    for (const FieldResult& f : s->fields()) out.back().fields.push_back(f.name);
    for (const CurveResult& c : s->curves()) out.back().curves.emplace_back(c.x_name, c.y_name);
  }
  return out;
}

std::vector<Columns> build(const Study& study, const StudyCase& c, const std::vector<double>& values,
                           const std::string& which, bool reduced) {
  try {
    return sensors_of(request_for(study, c, values, study.seed, reduced), study.executor.plugin_path);
  } catch (const Error& e) {
    throw Error(e.fault(), study.file + " " + c.pointer + (reduced ? "/reduced" : "/case") +
                               ": with all parameters at " + which + ": " + e.what());
  }
}

void check_columns(const Study& study, const StudyObservable& o, const std::string& pointer,
                   const std::vector<Columns>& sensors) {
  std::vector<std::string> names;
  for (const Columns& s : sensors) names.push_back(s.sensor);
  const auto at = std::find_if(sensors.begin(), sensors.end(), [&](const Columns& s) { return s.sensor == o.sensor; });
  if (at == sensors.end())
    fail(study, pointer + "/sensor",
         "case \"" + o.case_name + "\" has no sensor \"" + o.sensor + "\"; " + did_you_mean(o.sensor, names));
  if (o.is_map) {
    if (std::count(at->fields.begin(), at->fields.end(), o.column) == 0)
      fail(study, pointer + "/field",
           "sensor \"" + o.sensor + "\" has no field \"" + o.column + "\"; " +
               (at->fields.empty() ? "only a sensor of the kind \"height-map\" has one"
                                   : did_you_mean(o.column, at->fields)));
    return;
  }
  if (std::count(at->curves.begin(), at->curves.end(), std::make_pair(o.against, o.column)) > 0) return;
  std::vector<std::string> columns = at->columns;
  const auto check = [&](const std::string& key, const std::string& column) {
    if (std::find(columns.begin(), columns.end(), column) == columns.end())
      fail(study, pointer + "/" + key,
           "sensor \"" + o.sensor + "\" has no column \"" + column + "\"; " + did_you_mean(column, columns));
  };
  check("column", o.column);
  columns.insert(columns.begin(), "time_s");
  if (!o.against.empty()) check("against", o.against);
}

std::vector<double> middle_values(const Study& study) {
  std::vector<double> out;
  for (const StudyParameter& p : study.parameters) out.push_back(0.5 * (p.low + p.high));
  return out;
}

}  // namespace

void check_reading(const Study& study, const StudyObservable& reading, const std::string& pointer) {
  check_columns(
      study, reading, pointer,
      build(study, case_of(study, reading.case_name), middle_values(study), "the middle of their ranges", false));
}

void try_run(const RunRequest& request, const std::vector<std::string>& plugin_path) {
  sensors_of(request, plugin_path);
}

void check_cases(const Study& study) {
  std::vector<double> low, high;
  const std::vector<double> middle = middle_values(study);
  for (const StudyParameter& p : study.parameters) {
    low.push_back(p.low);
    high.push_back(p.high);
  }
  for (const StudyCase& c : study.cases)
    for (const bool reduced : {false, true}) {
      if (reduced && c.reduced.empty()) continue;
      const std::vector<Columns> sensors = build(study, c, middle, "the middle of their ranges", reduced);
      for (const StudyObservable& o : study.observables)
        if (o.case_name == c.name) check_columns(study, o, o.pointer, sensors);
      build(study, c, low, "their lowest value", reduced);
      build(study, c, high, "their highest value", reduced);
    }
}

}  // namespace calx
