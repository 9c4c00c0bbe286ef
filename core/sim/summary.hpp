// summary.hpp: summary.json and fields.json of a run. Private to sim/.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace calx {

struct RunFacts {
  std::string status;  // running, done, interrupted, stopped
  std::string reason;  // of a stop
  std::string case_sha256, started;
  double wall_seconds = 0;
  double rate = 0;  // particle-steps per second of wall time, of this process
  bool mixed = false;
  int threads = 0;
  std::vector<std::pair<std::string, double>> events;  // name, s
  std::vector<std::vector<double>> last;               // last row of each sensor
  std::vector<std::string> notes;
};

std::string summary_json(Simulation& simulation, const RunFacts& facts);
/// Fields and curves of the sensors as they stand.
std::string fields_json(Simulation& simulation);

}  // namespace calx
