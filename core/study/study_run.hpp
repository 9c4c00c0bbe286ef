// study_run.hpp: a run as the tables of a study show it, and what all runs cost.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "study/executor.hpp"

namespace calx {

struct StudyRun {
  std::string case_name, folder, error;
  std::uint64_t seed = 0;
  bool reduced = false, cached = false;
  double wall_seconds = 0;
  std::vector<double> values;  // of the parameters, in their units

  void take(const RunResult& result);
};

/// Sums over runs, as cost.json holds them.
class StudyCost {
 public:
  void add(const StudyRun& run);
  /// executor: its kind.
  std::string json(const std::string& executor) const;

 private:
  std::size_t runs_ = 0, cached_ = 0, failed_ = 0;
  double seconds_ = 0, seconds_now_ = 0;
};

}  // namespace calx
