#include "study/observe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "io/io.hpp"
#include "study/height_scan.hpp"
#include "study/table.hpp"

namespace calx {
namespace {

using Json = nlohmann::json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Json read_json(const std::string& path) {
  Json out = Json::parse(read_text(path), nullptr, false);
  if (out.is_discarded()) throw Error(Fault::files, path + ": is not valid JSON");
  return out;
}

double number(const Json& value) { return value.is_number() ? value.get<double>() : kNone; }

struct Series {
  std::vector<double> x, y;
};

bool curve_of_fields(const std::string& folder, const StudyObservable& o, Series& out) {
  const Json fields = read_json(folder + "/fields.json");
  for (const Json& c : fields["curves"]) {
    if (c["sensor"] != o.sensor || c["x_name"] != o.against || c["y_name"] != o.column) continue;
    for (const Json& v : c["x"]) out.x.push_back(number(v));
    for (const Json& v : c["y"]) out.y.push_back(number(v));
    return true;
  }
  return false;
}

Series series_of(const std::string& folder, const StudyObservable& o) {
  const std::string path = folder + "/series/" + o.sensor + ".csv";
  const Table table = parse_table(read_text(path), path);
  const auto at = [&](const std::string& name) {
    return std::find(table.columns.begin(), table.columns.end(), name) - table.columns.begin();
  };
  const auto x = static_cast<std::size_t>(at(o.against)), y = static_cast<std::size_t>(at(o.column));
  Series out;
  if (x >= table.columns.size() || y >= table.columns.size()) {
    if (!curve_of_fields(folder, o, out))
      throw Error(Fault::files, path + ": has no columns \"" + o.against + "\" and \"" + o.column + "\"");
    return out;
  }
  for (const auto& row : table.rows) {
    out.x.push_back(row[x]);
    out.y.push_back(row[y]);
  }
  return out;
}

}  // namespace

double passing(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  for (std::size_t k = 0; k < xs.size(); ++k) {
    if (xs[k] == x) return ys[k];  // the very place, so that no neighbour is needed
    if (k == 0 || !((xs[k - 1] < x && x < xs[k]) || (xs[k] < x && x < xs[k - 1]))) continue;
    const double share = (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
    return ys[k - 1] + share * (ys[k] - ys[k - 1]);
  }
  // Samples are taken in the step nearest to their time, so that the last one of a run to 2 s may stand at 1.99999 s.
  const std::size_t n = xs.size();
  if (n < 2) return kNone;
  if (std::fabs(x - xs[n - 1]) <= 0.5 * std::fabs(xs[n - 1] - xs[n - 2])) return ys[n - 1];
  if (std::fabs(x - xs[0]) <= 0.5 * std::fabs(xs[1] - xs[0])) return ys[0];
  return kNone;
}

std::vector<double> observe(const std::string& folder, const StudyObservable& o) {
  if (o.against.empty()) {
    const Json summary = read_json(folder + "/summary.json");
    const Json::json_pointer place = Json::json_pointer("/sensors") / o.sensor / "last" / o.column;
    return {summary.contains(place) ? o.factor * number(summary[place]) : kNone};
  }
  if (o.is_map) {
    std::vector<double> modes = modes_of(o.scan, o.scan.x, o.scan.y, heights_at(folder, o));
    for (double& m : modes) m *= o.factor;
    return modes;
  }
  const Series series = series_of(folder, o);
  std::vector<double> out;
  for (const double x : o.measured.x) out.push_back(o.factor * passing(series.x, series.y, x));
  return out;
}

std::string why_not(const std::string& folder, const StudyObservable& o) {
  const Json summary = read_json(folder + "/summary.json");
  const Json::json_pointer place = Json::json_pointer("/sensors") / o.sensor / "reason";
  if (summary.contains(place) && summary[place].is_string()) return summary[place].get<std::string>();
  return "the series of sensor \"" + o.sensor + "\" " +
         (o.against.empty() ? "ends without a number" : "does not reach every measured place");
}

}  // namespace calx
