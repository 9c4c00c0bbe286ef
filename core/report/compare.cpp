#include "report/compare.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

using Json = nlohmann::json;

RunFolder read(const std::string& dir) {
  namespace fs = std::filesystem;
  if (fs::is_directory(dir) && !fs::exists(dir + "/summary.json") && !fs::exists(dir + "/case.json"))
    throw Error(Fault::files,
                dir + ": holds no run, neither summary.json nor case.json; give the folder of a run (-o of calx run)");
  return read_run_folder(dir);
}

std::string short_text(const Json& value) {
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

void compare_json(const Json& a, const Json& b, const std::string& pointer, std::vector<GivenDifference>& out) {
  if (a == b) return;
  if (a.is_object() && b.is_object()) {
    std::set<std::string> keys;
    for (const Json* side : {&a, &b})
      for (const auto& item : side->items()) keys.insert(item.key());
    for (const std::string& key : keys) {
      const std::string at = pointer + "/" + key;
      if (a.contains(key) && b.contains(key))
        compare_json(a[key], b[key], at, out);
      else
        out.push_back({at, a.contains(key) ? short_text(a[key]) : "-", b.contains(key) ? short_text(b[key]) : "-"});
    }
  } else if (a.is_array() && b.is_array() && a.size() == b.size()) {
    for (std::size_t k = 0; k < a.size(); ++k) compare_json(a[k], b[k], pointer + "/" + std::to_string(k), out);
  } else {
    out.push_back({pointer, short_text(a), short_text(b)});
  }
}

/// Rows of both lists under one name, in the order of a, then what b alone has. Times of starting differ always.
std::vector<GivenDifference> compare_rows(const std::vector<std::pair<std::string, std::string>>& a,
                                          const std::vector<std::pair<std::string, std::string>>& b) {
  std::vector<GivenDifference> out;
  const auto find = [](const auto& list, const std::string& name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.first == name; });
    return at == list.end() ? std::string("-") : at->second;
  };
  for (const auto& [name, value] : a)
    if (name != "started" && find(b, name) != value) out.push_back({name, value, find(b, name)});
  for (const auto& [name, value] : b)
    if (name != "started" && find(a, name) == "-") out.push_back({name, "-", value});
  return out;
}

std::vector<std::pair<std::string, std::string>> provenance_rows(const RunFolder& run) {
  std::vector<std::pair<std::string, std::string>> out = run.provenance;
  for (const PluginRow& p : run.plugins) out.emplace_back("plugin " + p.id, p.version + " " + p.hash.substr(0, 12));
  return out;
}

std::vector<NamedValue> figure_rows(const RunFolder& run) {
  std::vector<NamedValue> out = {
      {"time_s", run.time}, {"time_step_s", run.time_step}, {"steps", run.steps}, {"particles", run.particles}};
  for (const NamedValue& m : run.mass) out.push_back({"mass " + m.name, m.value});
  for (const NamedValue& e : run.energy) out.push_back({"energy " + e.name, e.value});
  for (const NamedValue& e : run.events) out.push_back({"event " + e.name + "_s", e.value});
  for (const SensorSeries& s : run.sensors)
    for (const NamedValue& last : s.last) out.push_back({s.name + " " + last.name, last.value});
  return out;
}

void compare_figures(RunComparison& c) {
  const std::vector<NamedValue> a = figure_rows(c.a), b = figure_rows(c.b);
  for (const NamedValue& one : a) {
    if (!has_value(b, one.name)) {
      c.only_a.push_back(one.name);
      continue;
    }
    FigureDifference row;
    row.name = one.name;
    row.a = one.value;
    row.b = value_of(b, one.name, 0);
    row.difference = row.b - row.a;
    row.relative = row.difference == 0 ? 0 : row.difference / std::fabs(row.a);
    c.figures.push_back(row);
  }
  for (const NamedValue& one : b)
    if (!has_value(a, one.name)) c.only_b.push_back(one.name);
}

/// Value of a column at time t, linear between rows; not-a-number beyond them.
double value_at(const std::vector<double>& time, const std::vector<double>& values, double t) {
  const auto after = std::lower_bound(time.begin(), time.end(), t);
  if (after == time.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(after - time.begin());
  if (*after == t) return values[k];  // the very number that was read
  if (k == 0) return std::numeric_limits<double>::quiet_NaN();
  const double share = (t - time[k - 1]) / (time[k] - time[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

void compare_series(RunComparison& c) {
  const auto names = [](const RunFolder& run) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const SensorSeries& s : run.sensors)
      for (const std::string& column : s.columns) out.emplace_back(s.name, column);
    return out;
  };
  const auto all_a = names(c.a), all_b = names(c.b);
  const auto lacks = [](const auto& list, const auto& one) {
    return std::find(list.begin(), list.end(), one) == list.end();
  };
  for (const auto& one : all_a)
    if (lacks(all_b, one)) c.only_a.push_back(one.first + "/" + one.second);
  for (const auto& one : all_b)
    if (lacks(all_a, one)) c.only_b.push_back(one.first + "/" + one.second);
  for (const SensorSeries& a : c.a.sensors) {
    const auto b =
        std::find_if(c.b.sensors.begin(), c.b.sensors.end(), [&](const SensorSeries& s) { return s.name == a.name; });
    if (b == c.b.sensors.end()) continue;
    for (std::size_t k = 0; k < a.columns.size(); ++k) {
      const int other = b->column(a.columns[k]);
      if (other < 0 || k >= a.values.size() || static_cast<std::size_t>(other) >= b->values.size()) continue;
      const std::vector<double>& in_b = b->values[static_cast<std::size_t>(other)];
      SeriesDifference row;
      row.sensor = a.name;
      row.column = a.columns[k];
      row.in_step = a.time == b->time;
      for (std::size_t r = 0; r < a.time.size(); ++r) {
        const double x = a.values[k][r], y = value_at(b->time, in_b, a.time[r]);
        if (std::isfinite(x)) row.range = std::max(row.range, std::fabs(x));
        if (!b->time.empty() && a.time[r] <= b->time.back() && a.time[r] >= b->time.front())
          row.same = row.same && std::isnan(x) == std::isnan(y) && !(x < y) && !(x > y);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        ++row.rows;
        if (std::fabs(y - x) <= row.largest) continue;
        row.largest = std::fabs(y - x);
        row.at = a.time[r];
      }
      c.series.push_back(row);
    }
  }
}

/// One word for what a place of the case gives; empty: nothing that a result depends on.
std::string cause_of(const std::string& pointer) {
  for (const char* aside : {"/title", "/assumptions", "/output"})
    if (pointer.rfind(aside, 0) == 0) return "";
  if (pointer == "/seed") return "seed";
  if (pointer == "/time/integrator") return "integrator";
  return pointer == "/time/step" || pointer == "/time/rayleigh_fraction" ? "time step" : "case";
}

std::string series_verdict(const RunComparison& c) {
  if (c.series.empty()) return "There are no series to compare.";
  bool same = c.only_a.empty() && c.only_b.empty(), in_step = true;
  for (const SeriesDifference& s : c.series) {
    same = same && s.same;
    in_step = in_step && s.in_step;
  }
  if (!same) return "Series differ.";
  return in_step ? "All series are the same to every digit written." : "Series are the same where both have rows.";
}

std::string verdict(const RunComparison& c) {
  std::set<std::string> causes;
  for (const GivenDifference& one : c.given) causes.insert(cause_of(one.name));
  causes.erase("");
  for (const GivenDifference& one : c.provenance) {
    // The hash and the name of the case follow from what stands in it.
    if (one.name == "case_sha256" || one.name == "case_file" || one.name == "effects") continue;
    causes.insert(one.name.rfind("plugin ", 0) == 0                              ? "plugins"
                  : one.name == "git" || one.name == "calx" || one.name == "abi" ? "version"
                                                                                 : one.name);
  }
  const std::string series = series_verdict(c);
  if (causes.empty()) {
    const std::string doubt = " One of them may have stopped early, or a plugin does not repeat itself.";
    return "Both runs were given the same. " + series + (series == "Series differ." ? doubt : "");
  }
  if (causes.size() > 1) {
    std::string list;
    for (const std::string& one : causes) list += (list.empty() ? "" : ", ") + one;
    return "The runs differ in: " + list + ". " + series;
  }
  const std::string cause = *causes.begin();
  if (cause == "seed")
    return "The runs differ in the seed alone: what follows is the scatter of random choices. " + series;
  if (cause == "time step")
    return "The runs differ in the time step alone (" + brief_quantity(1e6 * c.a.time_step, "us") + ", " +
           brief_quantity(1e6 * c.b.time_step, "us") +
           "): what follows is its effect, and chaos of single particles. " + series;
  if (cause == "threads") return "The runs differ in threads alone, which change no bit. " + series;
  return "The runs differ in " + cause + " alone. " + series;
}

}  // namespace

RunComparison compare_runs(const std::string& a, const std::string& b) {
  RunComparison c;
  c.a = read(a);
  c.b = read(b);
  c.provenance = compare_rows(provenance_rows(c.a), provenance_rows(c.b));
  const Json one = Json::parse(c.a.case_text, nullptr, false), other = Json::parse(c.b.case_text, nullptr, false);
  if (one.is_object() && other.is_object()) compare_json(one, other, "", c.given);
  // The hash of a case says no more than its differences.
  if (!c.given.empty())
    c.provenance.erase(std::remove_if(c.provenance.begin(), c.provenance.end(),
                                      [](const GivenDifference& row) { return row.name == "case_sha256"; }),
                       c.provenance.end());
  compare_figures(c);
  compare_series(c);
  c.verdict = verdict(c);
  return c;
}

std::string comparison_json(const RunComparison& c) {
  const auto given = [](const std::vector<GivenDifference>& rows) {
    Json out = Json::array();
    for (const GivenDifference& row : rows) out.push_back({{"name", row.name}, {"a", row.a}, {"b", row.b}});
    return out;
  };
  Json figures = Json::array(), series = Json::array();
  for (const FigureDifference& f : c.figures)  // what is not finite becomes null
    figures.push_back(
        {{"name", f.name}, {"a", f.a}, {"b", f.b}, {"difference", f.difference}, {"relative", f.relative}});
  for (const SeriesDifference& s : c.series)
    series.push_back({{"sensor", s.sensor},
                      {"column", s.column},
                      {"rows", s.rows},
                      {"largest", s.largest},
                      {"at_s", s.at},
                      {"range", s.range},
                      {"same", s.same},
                      {"in_step", s.in_step}});
  const Json out = {{"a", c.a.dir},
                    {"b", c.b.dir},
                    {"verdict", c.verdict},
                    {"provenance", given(c.provenance)},
                    {"given", given(c.given)},
                    {"figures", figures},
                    {"series", series},
                    {"only_a", c.only_a},
                    {"only_b", c.only_b}};
  return out.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace calx
