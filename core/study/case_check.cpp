#include "study/case_check.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "sim/simulation.hpp"
#include "study/resolve.hpp"

namespace calx {
namespace {

struct Columns {
  std::string sensor;
  std::vector<std::string> columns;
};

[[noreturn]] void fail(const Study& study, const std::string& pointer, const std::string& what) {
  throw Error(Fault::settings, study.file + " " + pointer + ": " + what);
}

std::vector<Columns> build(const Study& study, const StudyCase& c, const std::vector<double>& values,
                           const std::string& which, bool reduced) {
  try {
    SimulationOptions options;
    options.threads = 1;
    options.device = "cpu";
    options.plugin_path = study.executor.plugin_path;
    Simulation sim(resolve(request_for(study, c, values, study.seed, reduced), options.plugin_path), options);
    std::vector<Columns> out;
    for (const auto& s : sim.sensors()) out.push_back({s->name(), s->columns()});
    return out;
  } catch (const Error& e) {
    throw Error(e.fault(), study.file + " " + c.pointer + (reduced ? "/reduced" : "/case") +
                               ": with all parameters at " + which + ": " + e.what());
  }
}

void check_columns(const Study& study, const StudyCase& c, const std::vector<Columns>& sensors) {
  for (const StudyObservable& o : study.observables) {
    if (o.case_name != c.name) continue;
    std::vector<std::string> names;
    for (const Columns& s : sensors) names.push_back(s.sensor);
    const auto at =
        std::find_if(sensors.begin(), sensors.end(), [&](const Columns& s) { return s.sensor == o.sensor; });
    if (at == sensors.end())
      fail(study, o.pointer + "/sensor",
           "case \"" + c.name + "\" has no sensor \"" + o.sensor + "\"; " + did_you_mean(o.sensor, names));
    std::vector<std::string> columns = at->columns;
    const auto check = [&](const std::string& key, const std::string& column) {
      if (std::find(columns.begin(), columns.end(), column) == columns.end())
        fail(study, o.pointer + "/" + key,
             "sensor \"" + o.sensor + "\" has no column \"" + column + "\"; " + did_you_mean(column, columns));
    };
    check("column", o.column);
    columns.insert(columns.begin(), "time_s");
    if (!o.against.empty()) check("against", o.against);
  }
}

}  // namespace

void check_cases(const Study& study) {
  std::vector<double> low, middle, high;
  for (const StudyParameter& p : study.parameters) {
    low.push_back(p.low);
    middle.push_back(0.5 * (p.low + p.high));
    high.push_back(p.high);
  }
  for (const StudyCase& c : study.cases)
    for (const bool reduced : {false, true}) {
      if (reduced && c.reduced.empty()) continue;
      check_columns(study, c, build(study, c, middle, "the middle of their ranges", reduced));
      build(study, c, low, "their lowest value", reduced);
      build(study, c, high, "their highest value", reduced);
    }
}

}  // namespace calx
