// study.hpp: a study as typed, checked settings: cases, parameters with ranges and priors, observables with their
// measured data. What only the diagnosis reads stays JSON text. Measured values are in the unit of their observable.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "study/executor.hpp"

namespace calx {

/// A case that the study runs.
struct StudyCase {
  std::string name, pointer;
  std::string path;                                      // absolute
  std::vector<std::pair<std::string, std::string>> set;  // JSON pointer -> JSON value
  std::string reduced;             // absolute path of a cheaper case with the same sensors; empty: none
  double reduced_tolerance = 0.1;  // share of a figure by which the reduced case may differ from the full one (sd)
};

struct StudyParameter {
  std::string name, unit, pointer;
  std::vector<std::string> set;    // JSON pointers that take the value
  std::vector<std::string> cases;  // names of the cases it is set in; all when the study names none
  double low = 0, high = 0;        // range, in unit
  enum class Prior { uniform, normal } prior = Prior::uniform;
  double mean = 0, sd = 0;  // of a normal prior, cut off at the range
};

/// What was measured, in the unit of the observable. Scalars have one value and no x.
struct MeasuredData {
  std::vector<double> x;                  // in the unit of the column it is measured against
  std::vector<double> y;                  // mean over repeats
  std::vector<double> sd;                 // of one repeat
  std::size_t repeats = 1;                // values averaged in y
  std::vector<std::vector<double>> each;  // every repeat, as y; empty where only the mean is known
  double correlation = 0;                 // of neighbouring points of one repeat (autocorrelation)
  bool sd_estimated = false;              // sd comes from the repeats themselves
  std::string source;                     // file, for reports; empty: stands in the study
};

/// Where a surface was scanned, m, in the frame of the case: the points of all repeats, and the rectangle around them.
struct HeightScan {
  std::vector<double> x, y;
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0;
};

struct StudyObservable {
  std::string name, kind, pointer;
  std::string case_name, sensor, column, against;  // against: column that x belongs to; empty: a last value
  std::string unit;                                // of the measured values; column is converted to it
  double factor = 1;                               // value in unit = factor * value of the column
  enum class Use { fit, hold_out } use = Use::fit;
  MeasuredData measured;
  bool is_map = false;  // column is a field of the sensor, and the figures are the modes of height_scan.hpp
  HeightScan scan;
  std::vector<double> simulated;  // by another program, at the prior of the parameters: the diagnosis is of that one
  double simulated_sd = 0;        // of one of these, from seed to seed
  double tolerance = 0;  // sd of what the model may miss, in unit: declared, or 0.35 of the mean sd of one repeat
  std::vector<std::pair<std::string, double>> conditions;
};

struct Study {
  std::string file, folder, title;
  std::vector<StudyCase> cases;
  std::vector<StudyParameter> parameters;
  std::vector<StudyObservable> observables;
  std::size_t seeds = 3;  // runs with other random numbers per place of the parameters
  std::size_t budget = 60;
  ExecutorSettings executor;
  std::uint64_t seed = 1;
  std::vector<std::string> assumptions;
  std::string effects = "[]", experiments = "[]", roles = "{}", claims = "[]";  // JSON text that the diagnosis reads
  std::string generic_terms = "[]";                                             // likewise
  bool named_effects_only = false;                                              // of the library of candidate causes
  std::string text;                                                             // of the file, for its hash
};

/// Reads and checks a study, its cases (read, not run: every sensor and column must exist) and its measured data.
/// Throws Error(Fault::settings): "study.json /observables/0/kind: ...", for data files "discharge.csv line 7: ..." or
/// the pointer that names them; Error(Fault::files) when the study itself cannot be read.
/// plugin_path: folders searched first for plugins.
Study read_study(const std::string& path, const std::vector<std::string>& plugin_path = {});

/// JSON Schema (draft 2020-12) of a study file.
std::string study_schema();

/// Every kind of observable that a study may name, with what it is.
const std::vector<std::pair<std::string, std::string>>& observable_kinds();

/// Mean and standard deviation of the prior as a diagnosis standardises by; of a uniform one, those of its range.
double prior_mean(const StudyParameter& p);
double prior_sd(const StudyParameter& p);
/// Of so many prior standard deviations from the mean, kept in the range; in the parameter's unit.
double parameter_value(const StudyParameter& p, double standardised);

const StudyCase& case_of(const Study& study, const std::string& name);

/// The run of a case at the values of the parameters, in their units and the order of study.parameters.
RunRequest request_for(const Study& study, const StudyCase& which, const std::vector<double>& values,
                       std::uint64_t seed, bool reduced = false);

}  // namespace calx
