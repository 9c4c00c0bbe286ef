#include "study/study_run.hpp"

#include <nlohmann/json.hpp>

namespace calx {

void StudyRun::take(const RunResult& result) {
  folder = result.folder, error = result.error;
  cached = result.cached, wall_seconds = result.wall_seconds;
}

void StudyCost::add(const StudyRun& run) {
  ++runs_;
  cached_ += run.cached ? 1 : 0;
  failed_ += run.error.empty() ? 0 : 1;
  seconds_ += run.wall_seconds;
  seconds_now_ += run.cached ? 0 : run.wall_seconds;
}

std::string StudyCost::json(const std::string& executor) const {
  const nlohmann::ordered_json j = {{"runs", runs_},       {"cached", cached_},       {"computed", runs_ - cached_},
                                    {"failed", failed_},   {"run_seconds", seconds_}, {"run_seconds_now", seconds_now_},
                                    {"executor", executor}};
  return j.dump(2) + "\n";
}

}  // namespace calx
