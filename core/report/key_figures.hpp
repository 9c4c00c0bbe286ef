// key_figures.hpp: the figures at the head of a report, from the sensors of a run.
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "report/run_folder.hpp"
#include "report/statistics.hpp"

namespace calx {

/// Masses of the completed cycles of one cycle-mass sensor, kg.
struct CycleFigures {
  std::string sensor;
  std::vector<double> cycle, each, total;  // cycle number, gained in it, gained since the start
  double first = 3;                        // statistics leave out the cycles before: the feeder fills up
  Spread per_cycle;                        // over the cycles from first on; over all when there are fewer than five
  LinearFit line;                          // total against cycle, same cycles
};

struct KeyFigures {
  const SensorSeries* fill = nullptr;                        // the mass sensor that tells how full the vessel is
  double filled = std::numeric_limits<double>::quiet_NaN();  // kg, its last value
  CycleFigures cycles;                                       // no cycles: empty
  double energy_remainder = std::numeric_limits<double>::quiet_NaN();  // J
  double energy_work = std::numeric_limits<double>::quiet_NaN();       // J, the scale for the remainder
  enum class Closed { yes, no, unknown } ledger = Closed::unknown;
  std::string ledger_text;  // what was compared
};
KeyFigures key_figures(const RunFolder& run);

/// The first cycle-mass sensor's completed cycles.
CycleFigures cycle_figures(const SensorSeries& sensor);

/// Last finite value of that column; NaN when there is none.
double last_value(const SensorSeries& sensor, const std::string& column);
/// Value of the last row, NaN where that row has none: curves of fields.json are those of the same moment.
double last_row(const SensorSeries& sensor, const std::string& column);

}  // namespace calx
