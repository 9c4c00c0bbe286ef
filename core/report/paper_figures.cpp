#include "report/paper_figures.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/column_name.hpp"
#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"
#include "config/config.hpp"
#include "io/io.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A case without what does not change its numbers.
Json numbers_of(const std::string& text) {
  Json all = Json::parse(text, nullptr, false);
  if (all.is_object())
    for (const char* key : {"title", "assumptions", "output"}) all.erase(key);
  return all;
}

[[noreturn]] void fail(const PaperRows& rows, const PaperRow& row, const std::string& what) {
  throw Error(Fault::settings, rows.file + " " + row.pointer + "/calx: " + what);
}

double event_time(const PaperRows& rows, const PaperRow& row, const RunFolder& run, const std::string& name) {
  std::vector<std::string> known;
  for (const NamedValue& e : run.events) {
    if (e.name == name) return e.value;
    known.push_back(e.name);
  }
  fail(rows, row, "event \"" + name + "\" did not happen in " + run.dir + "; " + did_you_mean(name, known));
}

/// The last row at or before t; a row of the same step may carry a time that differs in the last digits.
double value_at(const SensorSeries& sensor, std::size_t column, double t) {
  double out = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < sensor.time.size() && sensor.time[k] <= t * (1 + 1e-9) + 1e-12; ++k)
    out = sensor.values[column][k];
  return out;
}

double term_value(const PaperRows& rows, const PaperRow& row, const PaperTerm& term, const RunFolder& run) {
  const auto at = std::find_if(run.sensors.begin(), run.sensors.end(),
                               [&](const SensorSeries& s) { return s.name == term.sensor; });
  if (at == run.sensors.end()) {
    std::vector<std::string> known;
    for (const SensorSeries& s : run.sensors) known.push_back(s.name);
    fail(rows, row,
         "no sensor is called \"" + term.sensor + "\" in " + run.dir + "; " + did_you_mean(term.sensor, known));
  }
  const int column = at->column(term.column);
  if (column < 0)
    fail(rows, row,
         "sensor \"" + term.sensor + "\" has no column \"" + term.column + "\"; " +
             did_you_mean(term.column, at->columns));
  const std::size_t c = static_cast<std::size_t>(column);
  const double end = std::numeric_limits<double>::max();
  double value = value_at(*at, c, term.at.empty() ? end : event_time(rows, row, run, term.at));
  if (!term.since.empty()) value -= value_at(*at, c, event_time(rows, row, run, term.since));
  const Unit from = parse_unit(split_column(term.column).unit), to = parse_unit(row.unit);
  if (!same_dimension(from, to))
    fail(rows, row,
         "column \"" + term.column + "\" holds a " + dimension_name(from) + "; the row's unit is " + row.unit);
  value *= from.factor / to.factor;
  return term.factor * value;
}

/// Finished runs of a form; says in result.missing which are not there and why.
std::vector<RunFolder> finished(const PaperRun& run, int form, std::size_t seeds, const std::string& out,
                                PaperResult& result) {
  std::vector<std::string>& missing = result.missing;
  std::vector<RunFolder> found;
  std::string not_run, outdated;
  for (std::size_t k = 0; k < std::min(seeds, run.seeds.size()); ++k) {
    const std::string seed = std::to_string(run.seeds[k]);
    const std::string folder = paper_run_folder(out, run, form, run.seeds[k]);
    const PaperRunState state = paper_run_state(folder, run.forms[form], run.seeds[k]);
    result.begun = result.begun || state != PaperRunState::missing;
    switch (state) {
      case PaperRunState::missing:
        not_run += (not_run.empty() ? "" : ", ") + seed;
        break;
      case PaperRunState::outdated:
        outdated += (outdated.empty() ? "" : ", ") + seed;
        break;
      case PaperRunState::unfinished: {
        const RunFolder partial = read_run_folder(folder);
        missing.push_back("Run \"" + run.name + "\", seed " + seed + ": not finished (" + partial.status + ", " +
                          format_quantity(partial.time, "s", 4) + " simulated)");
        break;
      }
      case PaperRunState::done:
        found.push_back(read_run_folder(folder));
        break;
    }
  }
  if (!not_run.empty()) missing.push_back("Run \"" + run.name + "\": not run yet with seed " + not_run);
  if (!outdated.empty())
    missing.push_back("Run \"" + run.name + "\": its case has changed since it ran with seed " + outdated +
                      "; run it again");
  return found;
}

std::vector<double> values_of(const PaperRows& rows, const PaperRow& row, int form, const std::vector<RunFolder>& runs,
                              std::vector<std::string>& missing) {
  std::vector<double> values;
  for (const RunFolder& run : runs) {
    double value = std::numeric_limits<double>::quiet_NaN();
    try {
      value = paper_value(rows, row, form, run);
      if (!std::isfinite(value)) {
        std::string why;
        for (const PaperTerm& term : row.figure.terms[form])
          for (const SensorSeries& s : run.sensors)
            if (s.name == term.sensor && why.empty() && !s.reason.empty()) why = ": " + s.reason;
        missing.push_back("Run " + run.dir + " is finished, but its figure is not a number" + why);
      }
    } catch (const Error& e) {
      missing.push_back(e.what());
    }
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> paper_overrides(const PaperForm& form, std::uint64_t seed) {
  auto out = form.set;
  out.emplace_back("/seed", std::to_string(seed));
  return out;
}

PaperRunState paper_run_state(const std::string& folder, const PaperForm& form, std::uint64_t seed) {
  // First, so that a case that cannot run is refused before anything is computed.
  const CaseFile now = read_case(form.case_path, paper_overrides(form, seed));
  if (!fs::exists(folder + "/summary.json") || !fs::exists(folder + "/case.json")) return PaperRunState::missing;
  if (numbers_of(read_text(folder + "/case.json")) != numbers_of(now.resolved)) return PaperRunState::outdated;
  const Json summary = Json::parse(read_text(folder + "/summary.json"), nullptr, false);
  const bool done =
      summary.is_object() && summary.value("status", Json()) == Json("done") && !summary.contains("reason");
  return done ? PaperRunState::done : PaperRunState::unfinished;
}

PaperDifference difference_to(double low, double high, const PaperReference& reference) {
  PaperDifference out;
  if (reference.kind == PaperReference::Kind::sign) {
    // The side of zero is all that is known.
    out.known = true;
    const double middle = (low + high) / 2;
    out.sign = middle > 0 ? 1 : middle < 0 ? -1 : 0;
    out.amount = middle;
    out.share = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  if (reference.kind != PaperReference::Kind::value && reference.kind != PaperReference::Kind::range) return out;
  out.known = true;
  double end = reference.low;
  if (high < reference.low) {
    out.amount = high - reference.low;
  } else if (low > reference.high) {
    out.amount = low - reference.high;
    end = reference.high;
  }
  out.sign = out.amount > 0 ? 1 : out.amount < 0 ? -1 : 0;
  out.share = end != 0 ? out.amount / std::fabs(end) : std::numeric_limits<double>::quiet_NaN();
  return out;
}

double paper_value(const PaperRows& rows, const PaperRow& row, int form, const RunFolder& run) {
  double sum = 0, size = 0;
  for (const PaperTerm& term : row.figure.terms[form]) {
    const double value = term_value(rows, row, term, run);
    sum += value;
    size += std::fabs(value);
  }
  // Masses that cancel leave the last digits of the terms; series carry nine.
  return std::fabs(sum) <= 1e-8 * size ? 0 : sum;
}

PaperResult paper_result(const PaperRows& rows, const PaperRow& row, int form, std::size_t seeds,
                         const std::string& out) {
  PaperResult result;
  const PaperRun& run = paper_run(rows, row.figure.run);
  const PaperRun& other = row.figure.minus_run.empty() ? run : paper_run(rows, row.figure.minus_run);
  result.exists = !run.forms[form].case_path.empty() && !other.forms[form].case_path.empty();
  if (!result.exists) return result;
  result.runs = finished(run, form, seeds, out, result);
  if (!row.has_figure()) return result;
  result.values = values_of(rows, row, form, result.runs, result.missing);
  result.spread = spread_of(result.values);
  result.pooled = result.spread.deviation;
  if (row.figure.minus_run.empty()) return result;

  const std::vector<RunFolder> runs = finished(other, form, seeds, out, result);
  const Spread minus = spread_of(values_of(rows, row, form, runs, result.missing));
  const Spread plus = result.spread;
  result.spread = {};
  result.pooled = 0;
  if (plus.count == 0 || minus.count == 0) return result;
  result.spread.count = std::min(plus.count, minus.count);
  result.spread.mean = plus.mean - minus.mean;
  const auto squares = [](const Spread& s) { return static_cast<double>(s.count - 1) * s.deviation * s.deviation; };
  const double freedom = static_cast<double>(plus.count + minus.count) - 2;
  result.pooled = freedom > 0 ? std::sqrt((squares(plus) + squares(minus)) / freedom) : 0;
  // Standard error of the difference of two means.
  result.spread.deviation =
      result.pooled * std::sqrt(1.0 / static_cast<double>(plus.count) + 1.0 / static_cast<double>(minus.count));
  return result;
}

}  // namespace calx
