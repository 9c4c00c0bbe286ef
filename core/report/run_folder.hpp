// run_folder.hpp: what a run's folder says, typed and tolerant: every file is optional, a run may still be going, and
// whatever is missing leaves a sentence for the reader instead of a failure.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/vec3.hpp"
#include "io/io.hpp"
#include "measure/measure.hpp"

namespace calx {

/// A number of summary.json with its path in its object: "regions canister", 2.183.
struct NamedValue {
  std::string name;
  double value = 0;
};

struct SensorSeries {
  std::string name, kind;
  double every = 0;                         // s; 0: not stated
  std::vector<std::string> columns;         // without time_s
  std::vector<double> time;                 // s
  std::vector<std::vector<double>> values;  // one vector per column, NaN where the file has none
  std::vector<NamedValue> last;
  std::string missing;  // why there are no rows; empty when there are
  std::string reason;   // why the last figure is not a number; empty: not stated
  /// Number of a column; -1 when there is none of that name.
  int column(const std::string& column_name) const;
};

struct StepLimitRow {
  std::string name, where;
  double seconds = 0;
  double refused_above = 0;  // s; 0: not stated
  bool binds = false;
};

struct PluginRow {
  std::string id, version, hash, note;
};

/// A figure beside its reference, or only a sentence.
struct DeviationRow {
  std::string text, unit, source;
  double value = 0, reference = 0;
  bool has_numbers = false;
};

struct RunFolder {
  std::string dir, title, status;
  bool has_summary = false;
  double time = 0, time_end = 0;      // s; time_end 0: not stated
  double steps = -1, particles = -1;  // negative: not stated
  double wall_seconds = -1, particle_steps_per_second = -1, time_step = -1;
  std::vector<NamedValue> mass, energy;
  std::vector<SensorSeries> sensors;
  std::vector<StepLimitRow> limits;
  StepLimitRow law_limit_seen;                           // at the largest overlap of the run; seconds 0: not stated
  double largest_overlap_share = -1, overlap_limit = 0;  // of the radius; -1, 0: not stated
  std::vector<std::pair<std::string, std::string>> provenance;
  std::vector<PluginRow> plugins;
  std::vector<std::string> assumptions;
  std::vector<DeviationRow> deviations;
  std::vector<NamedValue> events;  // name, time s
  std::string case_text;           // case.json, indented
  Vec3 gravity{0, 0, -9.81};
  std::vector<std::pair<std::string, FieldResult>> fields;  // sensor name, field
  std::vector<std::pair<std::string, CurveResult>> curves;  // sensor name, curve
  FrameSet frames;
  std::vector<std::string> notes;  // files that are absent or could not be read, and what is missing for it

  /// First sensor of that kind; null when there is none.
  const SensorSeries* sensor_of(const std::string& kind) const;
};

/// Throws Error(Fault::files) when dir is no folder; everything else becomes a note.
RunFolder read_run_folder(const std::string& dir);

/// Value of that name in a list of summary.json; fallback when there is none.
double value_of(const std::vector<NamedValue>& values, const std::string& name, double fallback);
bool has_value(const std::vector<NamedValue>& values, const std::string& name);

}  // namespace calx
