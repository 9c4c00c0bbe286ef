// next_measurements.hpp: the measurements that a study says could be made, as the diagnosis weighs them. Private to
// study/.
#pragma once
#include "infer/experiment.hpp"
#include "study/diagnose.hpp"

namespace calx {

/// A measurement that could be made: read from a case, or a known load put on a sensor.
struct PossibleMeasurement {
  std::string name;
  double cost = 1;
  std::vector<double> sd, tolerance;
  bool is_known_load = false;
  StudyObservable reading;             // of a case; measured.x holds its places
  std::string sensor;                  // of a known load
  std::vector<double> time, load, at;  // of a known load: s, SI; at: times it is read, s
};

/// Throws Error(Fault::settings) with the pointer into the study.
std::vector<PossibleMeasurement> read_experiments(const Study& study);

/// Runs what the measurements need beyond what was run, and weighs them; the best first.
std::vector<NextMeasurement> weigh_measurements(const Study& study, const std::vector<PossibleMeasurement>& possible,
                                                StudyDiagnosis& result, Executor& executor, const ProgressSink& sink);

}  // namespace calx
