#include "study/measured.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/column_name.hpp"
#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "infer/seed_scatter.hpp"
#include "study/height_scan.hpp"
#include "study/table.hpp"

namespace calx {
namespace {

/// Share of the scatter of one repeat that a model may miss when the study declares no tolerance: half of it is not
/// worth explaining, and zero would make the posterior narrower than any model deserves. House rule.
constexpr double kPresetTolerance = 0.35;
/// Degrees of freedom that speak for neighbours without correlation before any repeat is seen. House rule.
constexpr double kUncorrelated = 10;
constexpr double kMostCorrelated = 0.95;

struct NoiseModel {
  double sd = 0, relative = 0;  // absolute, in the observable's unit; share of the value
  bool given = false;
};

NoiseModel read_noise(Object& m, const std::string& unit) {
  NoiseModel out;
  if (const auto n = m.find("sd")) out.sd = n->number(unit, Allow::above_zero), out.given = true;
  if (const auto n = m.find("relative")) out.relative = n->number("1", Allow::above_zero), out.given = true;
  return out;
}

double sd_at(const NoiseModel& noise, double y) { return std::hypot(noise.sd, noise.relative * y); }

void too_few(const Node& node, std::size_t count) {
  node.fail("an sd cannot be estimated from " + std::to_string(count) + (count == 1 ? " repeat" : " repeats") +
            "; at least 2 are needed, or give \"sd\" (of one repeat)");
}

/// Values of one scalar: mean, and the sd of one repeat from the scatter unless it is given.
void from_repeats(const Node& node, const std::vector<double>& values, const NoiseModel& noise, MeasuredData& data) {
  double mean = 0, square = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) square += (v - mean) * (v - mean);
  data.y = {mean};
  data.repeats = values.size();
  for (const double v : values) data.each.push_back({v});
  if (noise.given) {
    data.sd = {sd_at(noise, mean)};
    return;
  }
  if (values.size() < 2) too_few(node, values.size());
  data.sd = {std::sqrt(square / static_cast<double>(values.size() - 1))};
  data.sd_estimated = true;
  if (!(data.sd[0] > 0)) node.fail("all repeats are equal, so that no scatter can be seen; give \"sd\"");
}

struct File {
  Table table;
  std::string name;
  const Node* node;

  std::size_t column(const Node& at, const std::string& name_) const {
    const auto it = std::find(table.columns.begin(), table.columns.end(), name_);
    if (it == table.columns.end())
      at.fail("\"" + name_ + "\" is no column of " + name + "; " + did_you_mean(name_, table.columns));
    return static_cast<std::size_t>(it - table.columns.begin());
  }
  [[noreturn]] void refuse(std::size_t row, const std::string& what) const {
    throw Error(Fault::settings, name + " line " + std::to_string(table.lines[row]) + ": " + what);
  }
  double value(std::size_t row, std::size_t column_) const {
    const double v = table.rows[row][column_];
    if (!std::isfinite(v))
      refuse(row, "column \"" + table.columns[column_] + "\" holds no finite number; take the row out or repair it");
    return v;
  }
};

/// Column's factor to a unit; a column whose name ends in no unit is taken to be in it.
double factor_of(const Node& node, const std::string& column, const std::string& to) {
  const std::string from = split_column(column).unit;
  return from.empty() ? 1 : unit_factor(node, from, to, "column \"" + column + "\"");
}

struct Repeat {
  std::vector<double> x, y;
};

/// Rows by repeat, x rising strictly within each.
std::vector<Repeat> repeats_of(Object& m, const File& file, const StudyObservable& o) {
  const Node y_node = m.need("y", "the column with the measured values");
  const std::string y_name = y_node.text("a column of the file");
  const std::size_t y = file.column(y_node, y_name);
  const double y_factor = factor_of(y_node, y_name, o.unit);
  std::size_t x = 0, group = 0;
  double x_factor = 1;
  const auto x_node = m.find("x"), repeat_node = m.find("repeat");
  if (!o.against.empty()) {
    if (!x_node) m.need("x", "the column with the places of the measured values");
    const std::string name = x_node->text("a column of the file");
    x = file.column(*x_node, name);
    const std::string to = split_column(o.against).unit;
    if (!to.empty()) x_factor = factor_of(*x_node, name, to);
  } else if (x_node) {
    x_node->fail("the observable is a last value; name the column it is measured \"against\" to make it a curve");
  }
  if (repeat_node) group = file.column(*repeat_node, repeat_node->text("a column of the file"));
  std::map<double, Repeat> by_repeat;
  for (std::size_t r = 0; r < file.table.rows.size(); ++r) {
    Repeat& to = by_repeat[repeat_node ? file.value(r, group) : 0];
    to.y.push_back(y_factor * file.value(r, y));
    if (o.against.empty()) continue;
    const double at = x_factor * file.value(r, x);
    if (!to.x.empty() && !(at > to.x.back()))
      file.refuse(r, "\"" + file.table.columns[x] + "\" " + (at == to.x.back() ? "repeats" : "falls below") +
                         " the value of the row before; it must rise within a repeat" +
                         (repeat_node ? "" : ", or name the column that tells repeats apart in \"repeat\""));
    to.x.push_back(at);
  }
  std::vector<Repeat> out;
  for (auto& one : by_repeat) out.push_back(std::move(one.second));
  return out;
}

/// sd and lag-one correlation of a curve from its repeats. Both are pooled over the places, since a few repeats say
/// little about each: an sd stays its own where places differ by more than chance. What adds up along the index, as
/// the mass in a vessel does, is correlated, and misleads where each of its numbers counts as news.
void scatter_of_curve(const Node& node, MeasuredData& data) {
  const auto places = static_cast<Eigen::Index>(data.y.size()), repeats = static_cast<Eigen::Index>(data.repeats);
  infer::Matrix z(places, repeats);
  for (Eigen::Index r = 0; r < repeats; ++r)
    for (Eigen::Index k = 0; k < places; ++k)
      z(k, r) =
          data.each[static_cast<std::size_t>(r)][static_cast<std::size_t>(k)] - data.y[static_cast<std::size_t>(k)];
  const double freedom = static_cast<double>(repeats - 1);
  const infer::Vector variances = z.rowwise().squaredNorm() / freedom;
  if (!(variances.mean() > 0)) node.fail("all repeats are equal; give \"sd\"");
  const infer::Vector sd = (variances.mean() * infer::shrunk_variances(variances, freedom)).cwiseSqrt();
  for (Eigen::Index k = 0; k < places; ++k) data.sd[static_cast<std::size_t>(k)] = sd[k];
  if (places < 4) return;
  z = sd.cwiseInverse().asDiagonal() * z;
  const double n = static_cast<double>(places), numbers = freedom * (n - 1),
               seen =
                   z.topRows(places - 1).cwiseProduct(z.bottomRows(places - 1)).sum() / z.squaredNorm() * n / (n - 1);
  data.correlation = std::clamp(seen * numbers / (numbers + kUncorrelated), 0.0, kMostCorrelated);
}

/// A scan with columns of x, y and height: the modes of each repeat, over the rectangle that all of them cover.
void from_scan(Object& m, const File& file, StudyObservable& o) {
  const auto column = [&](const char* key, const char* what) {
    const Node node = m.need(key, what);
    const std::string name = node.text("a column of the file");
    const std::size_t at = file.column(node, name);
    if (split_column(name).unit.empty())
      node.fail("column \"" + name + "\" of " + file.name + " ends in no unit; call it \"" + name + "_mm\" or \"" +
                name + "_m\"");
    return std::make_pair(
        at, unit_factor(node, split_column(name).unit, key[0] == 'z' ? o.unit : "m", "column \"" + name + "\""));
  };
  const auto x = column("x", "the column with the places along x"),
             y = column("y", "the column with the places along y"), z = column("z", "the column with the heights");
  const NoiseModel noise = read_noise(m, o.unit);
  const auto repeat_node = m.find("repeat");
  const std::size_t group = repeat_node ? file.column(*repeat_node, repeat_node->text("a column of the file")) : 0;
  struct Points {
    std::vector<double> x, y, z;
  };
  std::map<double, Points> by_repeat;
  for (std::size_t r = 0; r < file.table.rows.size(); ++r) {
    Points& to = by_repeat[repeat_node ? file.value(r, group) : 0];
    to.x.push_back(x.second * file.value(r, x.first)), to.y.push_back(y.second * file.value(r, y.first));
    to.z.push_back(z.second * file.value(r, z.first));
    o.scan.x.push_back(to.x.back()), o.scan.y.push_back(to.y.back());
  }
  const auto ends_x = std::minmax_element(o.scan.x.begin(), o.scan.x.end());
  const auto ends_y = std::minmax_element(o.scan.y.begin(), o.scan.y.end());
  o.scan.low_x = *ends_x.first, o.scan.high_x = *ends_x.second;
  o.scan.low_y = *ends_y.first, o.scan.high_y = *ends_y.second;
  if (!noise.given && by_repeat.size() < 2) too_few(*file.node, by_repeat.size());
  MeasuredData& data = o.measured;
  data.repeats = by_repeat.size();
  data.y.assign(scan_modes, 0);
  for (std::size_t k = 0; k < scan_modes; ++k) data.x.push_back(static_cast<double>(k));
  for (const auto& one : by_repeat) {
    data.each.push_back(modes_of(o.scan, one.second.x, one.second.y, one.second.z));
    if (!std::isfinite(data.each.back()[0]))
      file.node->fail("repeat " + format_number(one.first) + " of " + file.name + " holds " +
                      std::to_string(one.second.z.size()) + " points; " + std::to_string(2 * scan_modes) +
                      " or more, spread over x and y, are needed for the shape of a surface");
    for (std::size_t k = 0; k < scan_modes; ++k)
      data.y[k] += data.each.back()[k] / static_cast<double>(by_repeat.size());
  }
  double pooled = 0;
  for (const std::vector<double>& one : data.each)
    for (std::size_t k = 0; k < scan_modes; ++k) pooled += std::pow(one[k] - data.y[k], 2);
  pooled = std::sqrt(pooled / (std::max(static_cast<double>(data.repeats) - 1, 1.0) * scan_modes));
  data.sd_estimated = !noise.given;
  if (data.sd_estimated && !(pooled > 0))
    file.node->fail("all repeats are equal; give \"sd\" (of a mode of one repeat)");
  for (const double v : data.y) data.sd.push_back(noise.given ? sd_at(noise, v) : pooled);
}

void from_file(Object& m, const Node& file_node, StudyObservable& o) {
  const std::string given = file_node.text("the path of a CSV file");
  const std::string path = file_node.document().absolute_path(given);
  File file;
  try {
    file = {parse_table(read_text_file(path), given), given, &file_node};
  } catch (const Error& e) {
    throw Error(e.fault(), e.fault() == Fault::files
                               ? file_node.document().file() + " " + file_node.pointer() + ": " + e.what()
                               : e.what());
  }
  if (o.is_map) {
    o.measured.source = path;
    return from_scan(m, file, o);
  }
  const NoiseModel noise = read_noise(m, o.unit);
  std::vector<Repeat> repeats = repeats_of(m, file, o);
  MeasuredData& data = o.measured;
  data.source = path;
  if (o.against.empty()) {
    std::vector<double> values;
    for (const Repeat& r : repeats) values.insert(values.end(), r.y.begin(), r.y.end());
    from_repeats(file_node, values, noise, data);
    return;
  }
  data.x = repeats[0].x;
  data.repeats = repeats.size();
  for (const Repeat& r : repeats) data.each.push_back(r.y);
  for (std::size_t k = 1; k < repeats.size(); ++k)
    if (repeats[k].x != data.x)
      file_node.fail("repeat " + std::to_string(k + 1) + " of " + given +
                     " is measured at other places than the first; all repeats need the same");
  if (!noise.given && repeats.size() < 2) too_few(file_node, repeats.size());
  for (std::size_t k = 0; k < data.x.size(); ++k) {
    double mean = 0;
    for (const Repeat& r : repeats) mean += r.y[k] / static_cast<double>(repeats.size());
    data.y.push_back(mean);
    data.sd.push_back(sd_at(noise, mean));
  }
  data.sd_estimated = !noise.given;
  if (data.sd_estimated) scatter_of_curve(file_node, data);
}

void from_values(Object& m, const Node& node, const std::vector<double>& at, StudyObservable& o) {
  const NoiseModel noise = read_noise(m, o.unit);
  MeasuredData& data = o.measured;
  const auto one = m.find("value"), many = m.find("values");
  if (!one && !many) node.fail("holds no \"value\", \"values\" or \"file\"; a measured value is needed");
  if (one && many) many->fail("stands beside \"value\"; give one of them");
  std::size_t repeats = 1;
  if (const auto n = m.find("repeats")) {
    repeats = static_cast<std::size_t>(n->whole(1));
    if (many && at.empty() && repeats != many->items("numbers").size())
      n->fail("\"values\" already tells how many repeats there are; take \"repeats\" away");
  }
  const std::vector<double> y = many ? read_numbers(*many, o.unit) : std::vector<double>{one->number(o.unit)};
  if (y.empty()) many->fail("is empty; at least one measured value is needed");
  if (at.empty()) {
    if (!o.against.empty()) node.fail("a curve needs \"at\", the places of its values, or a \"file\"");
    from_repeats(many ? *many : *one, y, noise, data);
    if (!many) data.repeats = repeats, data.each.clear();
    return;
  }
  if (o.against.empty()) node.fail("\"at\" needs \"against\", the column it belongs to");
  if (y.size() != at.size())
    node.fail("holds " + std::to_string(y.size()) + " values for " + std::to_string(at.size()) + " places in \"at\"");
  if (!noise.given) node.fail("values of a curve need \"sd\" (of one repeat) or \"relative\"");
  data.x = at;
  data.y = y;
  data.repeats = repeats;
  for (const double v : y) data.sd.push_back(sd_at(noise, v));
}

}  // namespace

double unit_factor(const Node& node, const std::string& from, const std::string& to, const std::string& what) {
  try {
    const Unit a = parse_unit(from), b = parse_unit(to);
    if (!same_dimension(a, b))
      node.fail(what + " is in " + from + ", which measures a " + dimension_name(a) + "; a " + dimension_name(b) +
                " in " + to + " is needed");
    return a.factor / b.factor;
  } catch (const Error& e) {
    if (std::string(e.what()).compare(0, 5, "unit ") == 0) node.fail(e.what());
    throw;
  }
}

void read_reading(Object& observable, const std::vector<StudyCase>& cases, StudyObservable& o) {
  std::vector<std::string> names;
  for (const StudyCase& c : cases) names.push_back(c.name);
  o.case_name = observable.need("case", "the case of the study that gives it").name_of("case", names);
  o.sensor = observable.need("sensor", "the sensor of the case").text("the name of a sensor");
  if (const auto field = observable.find("field")) {
    if (o.kind != "pile-profile")
      field->fail("a field is a map of heights, of the kind \"pile-profile\"; kind \"" + o.kind + "\" has none");
    o.is_map = true, o.column = field->text("a field of the sensor"), o.against = "mode_1";
    for (const char* key : {"column", "against"})
      if (const auto other = observable.find(key)) other->fail("stands beside \"field\"; give one of them");
    const Node unit = observable.need("unit", "of the heights");
    o.unit = unit.text("a unit of length");
    o.factor = unit_factor(unit, "m", o.unit, "the field");
    return;
  }
  o.column = observable.need("column", "the column of the sensor").text("a column of the sensor");
  o.against = observable.text("against", "a column of the sensor, \"time_s\" for instance");
  const Node unit = observable.need("unit", "of the values, \"1\" for none");
  o.unit = unit.text("a unit, \"1\" for none");
  const std::string own = split_column(o.column).unit;
  o.factor = unit_factor(unit, own.empty() ? o.unit : own, o.unit, "column \"" + o.column + "\" of the sensor");
}

std::vector<double> read_numbers(const Node& node, const std::string& unit) {
  std::vector<double> out;
  for (const Node& n : node.items("numbers")) out.push_back(n.number(unit));
  return out;
}

void need_rising(const Node& node, const std::vector<double>& places) {
  for (std::size_t k = 1; k < places.size(); ++k)
    if (!(places[k] > places[k - 1])) node.fail("the places must rise; value " + std::to_string(k) + " does not");
}

void read_measured(Object& observable, StudyObservable& o) {
  const Node node = observable.need("measured", "what was measured: {\"value\": 40.5, \"sd\": 0.5}");
  std::vector<double> at;
  if (const auto n = observable.find("at")) {
    const std::string unit = split_column(o.against).unit;
    at = read_numbers(*n, unit.empty() ? "1" : unit);
    need_rising(*n, at);
  }
  Object m(node, "measured data");
  if (const auto file = m.find("file")) {
    if (!at.empty()) node.fail("\"at\" gives the places of values that stand in the study; a file brings its own");
    from_file(m, *file, o);
  } else {
    if (o.is_map) node.fail("a map needs a \"file\" with columns of x, y and height");
    from_values(m, node, at, o);
  }
  if (const auto n = m.find("autocorrelation")) {
    o.measured.correlation = n->number("1");
    if (!(std::fabs(o.measured.correlation) < 1))
      n->fail(format_number(o.measured.correlation) + " is out of range; must lie between -1 and 1");
  }
  m.done();
  double mean_sd = 0;
  for (const double s : o.measured.sd) mean_sd += s / static_cast<double>(o.measured.sd.size());
  const auto declared = observable.find("tolerance");
  o.tolerance = declared ? declared->number(o.unit, Allow::not_negative) : kPresetTolerance * mean_sd;
}

}  // namespace calx
