#include "report/run_folder.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "report/series_csv.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool load(const std::string& path, std::string& text) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return false;
  std::ostringstream all;
  all << in.rdbuf();
  text = all.str();
  return true;
}

json load_json(const std::string& dir, const std::string& file, const std::string& consequence,
               std::vector<std::string>& notes) {
  std::string text;
  if (!load(dir + "/" + file, text)) {
    notes.push_back(file + " is not there: " + consequence);
    return json();
  }
  json out = json::parse(text, nullptr, false);
  if (out.is_discarded()) {
    notes.push_back(file + " is not valid JSON (it may be half written): " + consequence);
    return json();
  }
  return out;
}

// Null when object is no object or has no such key.
json member(const json& object, const char* key) {
  if (!object.is_object()) return json();
  const auto at = object.find(key);
  return at == object.end() ? json() : *at;
}

double number(const json& object, const char* key, double fallback) {
  if (!object.is_object()) return fallback;
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? at->get<double>() : fallback;
}

std::string plain(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "";
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string text_of(const json& object, std::initializer_list<const char*> keys) {
  if (!object.is_object()) return "";
  for (const char* key : keys) {
    const auto at = object.find(key);
    if (at != object.end()) return plain(*at);
  }
  return "";
}

void flatten(const json& object, const std::string& prefix, std::vector<NamedValue>& out) {
  if (!object.is_object()) return;
  for (const auto& item : object.items()) {
    const std::string name = prefix.empty() ? item.key() : prefix + " " + item.key();
    if (item.value().is_number()) {
      out.push_back({name, item.value().get<double>()});
    } else if (item.value().is_boolean()) {
      out.push_back({name, item.value().get<bool>() ? 1.0 : 0.0});
    } else {
      flatten(item.value(), name, out);
    }
  }
}

// "canister mass" and "canister_mass" name the same file whatever the writer does with blanks.
std::string letters_of(const std::string& name) {
  std::string out;
  for (char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c))) out += static_cast<char>(std::tolower(c));
  }
  return out;
}

void read_provenance(const json& all, RunFolder& run) {
  if (!all.is_object()) return;
  for (const auto& item : all.items()) {
    if (item.key() != "plugins") {
      run.provenance.emplace_back(item.key(), plain(item.value()));
      continue;
    }
    for (const auto& plugin : item.value().items()) {
      const json& row = plugin.value();
      PluginRow out;
      out.id = text_of(row, {"id", "name"});
      if (out.id.empty() && item.value().is_object()) out.id = plugin.key();
      out.version = text_of(row, {"version"});
      out.hash = text_of(row, {"sha256", "hash"});
      out.note = text_of(row, {"vendor", "path", "library", "file"});
      run.plugins.push_back(out);
    }
  }
}

void read_summary(const json& all, RunFolder& run) {
  run.has_summary = all.is_object();
  if (!run.has_summary) return;
  run.title = text_of(all, {"title"});
  run.status = text_of(all, {"status"});
  run.time = number(all, "time", 0);
  run.steps = number(all, "steps", -1);
  run.particles = number(all, "particles", -1);
  run.wall_seconds = number(all, "wall_seconds", -1);
  run.particle_steps_per_second = number(all, "particle_steps_per_second", -1);
  run.time_step = number(all, "time_step", -1);
  flatten(member(all, "mass"), "", run.mass);
  flatten(member(all, "energy"), "", run.energy);
  const json sensors = member(all, "sensors");
  for (const auto& item : sensors.items()) {
    SensorSeries s;
    s.name = item.key();
    s.kind = text_of(item.value(), {"kind"});
    s.every = number(item.value(), "every", 0);
    s.reason = text_of(item.value(), {"reason"});
    if (item.value().is_object()) flatten(member(item.value(), "last"), "", s.last);
    run.sensors.push_back(s);
  }
  for (const json& row : member(all, "step_limits")) {
    run.limits.push_back({text_of(row, {"name"}), text_of(row, {"where"}), number(row, "seconds", 0),
                          number(row, "refused_above", 0), member(row, "binds") == json(true)});
  }
  const json seen = member(all, "law_limit_seen");
  run.law_limit_seen = {"law", text_of(seen, {"where"}), number(seen, "seconds", 0), 0, false};
  run.largest_overlap_share = number(all, "largest_overlap_share", -1);
  run.overlap_limit = number(all, "overlap_limit", 0);
  read_provenance(member(all, "provenance"), run);
  for (const json& row : member(all, "assumptions")) run.assumptions.push_back(plain(row));
  for (const json& row : member(all, "deviations")) {
    DeviationRow d;
    d.text = row.is_object() ? text_of(row, {"figure", "name", "text"}) : plain(row);
    d.unit = text_of(row, {"unit"});
    d.source = text_of(row, {"source"});
    d.value = number(row, "value", 0);
    d.reference = number(row, "reference", 0);
    d.has_numbers = row.is_object() && row.contains("value") && row.contains("reference");
    run.deviations.push_back(d);
  }
  for (const json& row : member(all, "events")) {
    const double t = number(row, "time", -1);
    if (t >= 0) run.events.push_back({text_of(row, {"name"}), t});
  }
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const NamedValue& a, const NamedValue& b) { return a.value < b.value; });
}

void read_case_facts(const json& all, RunFolder& run) {
  if (!all.is_object()) return;
  run.case_text = all.dump(2, ' ', false, json::error_handler_t::replace);
  if (run.title.empty()) run.title = text_of(all, {"title"});
  run.time_end = number(member(all, "time"), "end", 0);
  const json gravity = member(all, "gravity");
  if (gravity.is_array() && gravity.size() == 3 && gravity[0].is_number() && gravity[1].is_number() &&
      gravity[2].is_number()) {
    run.gravity = {gravity[0].get<double>(), gravity[1].get<double>(), gravity[2].get<double>()};
  }
  if (run.assumptions.empty()) {
    for (const json& row : member(all, "assumptions")) run.assumptions.push_back(plain(row));
  }
}

void read_series(RunFolder& run) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(run.dir + "/series", failed)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string letters = letters_of(file.stem().string());
    auto at = std::find_if(run.sensors.begin(), run.sensors.end(),
                           [&](const SensorSeries& s) { return letters_of(s.name) == letters; });
    if (at == run.sensors.end()) {
      SensorSeries s;
      s.name = file.stem().string();
      at = run.sensors.insert(run.sensors.end(), s);
    }
    std::string text;
    if (!load(file.string(), text)) continue;
    SeriesTable table = parse_series(text);
    at->columns = std::move(table.columns);
    at->time = std::move(table.time);
    at->values = std::move(table.values);
    if (at->time.empty()) at->missing = "series/" + file.filename().string() + " has no rows yet";
  }
  for (SensorSeries& s : run.sensors) {
    if (s.columns.empty() && s.missing.empty()) s.missing = "series/" + s.name + ".csv is not there";
  }
}

std::vector<double> numbers(const json& array) {
  std::vector<double> out;
  if (!array.is_array()) return out;
  for (const json& v : array) {
    out.push_back(v.is_number() ? v.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

void read_fields(const json& all, RunFolder& run) {
  if (!all.is_object()) return;
  for (const json& row : member(all, "fields")) {
    FieldResult f;
    f.name = text_of(row, {"name"});
    f.unit = text_of(row, {"unit"});
    f.nx = static_cast<std::size_t>(std::max(0.0, number(row, "nx", 0)));
    f.ny = static_cast<std::size_t>(std::max(0.0, number(row, "ny", 0)));
    f.cell = number(row, "cell", 0);
    const std::vector<double> origin = numbers(member(row, "origin"));
    if (origin.size() == 3) f.origin = {origin[0], origin[1], origin[2]};
    f.values = numbers(member(row, "values"));
    if (f.cell > 0 && f.nx > 0 && f.values.size() == f.nx * f.ny) {
      run.fields.emplace_back(text_of(row, {"sensor"}), f);
    } else {
      run.notes.push_back("fields.json: field \"" + f.name + "\" holds " + std::to_string(f.values.size()) +
                          " values for " + std::to_string(f.nx) + " x " + std::to_string(f.ny) + " cells: not drawn");
    }
  }
  for (const json& row : member(all, "curves")) {
    CurveResult c;
    c.name = text_of(row, {"name"});
    c.x_name = text_of(row, {"x_name"});
    c.y_name = text_of(row, {"y_name"});
    c.x = numbers(member(row, "x"));
    c.y = numbers(member(row, "y"));
    if (c.x.size() == c.y.size() && !c.x.empty()) run.curves.emplace_back(text_of(row, {"sensor"}), c);
  }
}

}  // namespace

int SensorSeries::column(const std::string& column_name) const {
  const auto at = std::find(columns.begin(), columns.end(), column_name);
  return at == columns.end() ? -1 : static_cast<int>(at - columns.begin());
}

const SensorSeries* RunFolder::sensor_of(const std::string& kind) const {
  for (const SensorSeries& s : sensors) {
    if (s.kind == kind) return &s;
  }
  return nullptr;
}

double value_of(const std::vector<NamedValue>& values, const std::string& name, double fallback) {
  for (const NamedValue& v : values) {
    if (v.name == name) return v.value;
  }
  return fallback;
}

bool has_value(const std::vector<NamedValue>& values, const std::string& name) {
  return std::any_of(values.begin(), values.end(), [&](const NamedValue& v) { return v.name == name; });
}

RunFolder read_run_folder(const std::string& dir) {
  if (!fs::is_directory(dir)) {
    throw Error(Fault::files,
                "cannot write a report: " + dir + " is not a folder; give the folder of a run (-o of calx run)");
  }
  RunFolder run;
  run.dir = dir;
  read_summary(load_json(dir, "summary.json", "status, figures, ledgers and provenance are missing", run.notes), run);
  read_case_facts(load_json(dir, "case.json", "the case as resolved is missing", run.notes), run);
  read_series(run);
  read_fields(load_json(dir, "fields.json", "height maps and pile profiles are missing", run.notes), run);
  try {
    run.frames = read_frame_set(dir);
    if (run.frames.times.empty()) {
      run.notes.push_back("particles.h5 is not there or holds no frame: pictures and playback are missing");
    }
  } catch (const Error& e) {
    run.frames = {};
    run.notes.push_back(std::string("particles.h5 could not be read: pictures and playback are missing: ") + e.what());
  }
  if (run.title.empty()) run.title = fs::absolute(dir).lexically_normal().filename().string();
  if (run.title.empty()) run.title = dir;
  if (run.status.empty()) run.status = run.has_summary ? "unknown" : "no summary yet";
  return run;
}

}  // namespace calx
