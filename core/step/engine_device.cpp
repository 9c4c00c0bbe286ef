// engine_device.cpp: steps of an engine that has a device, in batches between two looks at its flags, and what it
// shows.
#include <algorithm>

#include "compute/law_text.hpp"
#include "step/on_device.hpp"

namespace calx {

std::vector<std::string> Engine::device_obstacles() const {
  std::vector<std::string> reasons;
  for (const std::string& law : laws_without_text(laws))
    reasons.push_back("law \"" + law + "\" has no law text, only native code");
  for (const std::string& force : forces_without_text(forces))
    reasons.push_back("force \"" + force + "\" has no text, only native code");
  if (options.rest.on) reasons.push_back("particles at rest (/rest) are not there on devices");
  return reasons;
}

void Engine::use_device(std::unique_ptr<Device> device, bool fast) {
  device_ = std::make_unique<OnDevice>(std::move(device), *this, fast);
}

void Engine::fetch() const {
  if (device_) device_->fetch();
}

void Engine::fetch_loads() const {
  if (device_) device_->fetch_sums();
}

const PairList& Engine::pairs() const {
  if (device_) device_->fetch_lists();
  return pairs_;
}
const WallList& Engine::walls() const {
  if (device_) device_->fetch_lists();
  return walls_;
}
std::size_t Engine::pair_entry_count() const { return device_ ? device_->entry_count() : pairs_.entry_count(); }
std::size_t Engine::wall_row_count() const { return device_ ? device_->wall_row_count() : walls_.row_count(); }

const EngineEnergy& Engine::energy() const {
  if (device_) device_->fetch_sums();
  return energy_;
}
std::uint64_t Engine::touching() const {
  if (device_) device_->fetch_sums();
  return touching_;
}
double Engine::largest_overlap() const {
  if (device_) device_->fetch_sums();
  return largest_overlap_;
}

std::uint64_t Engine::bytes_fetched() const { return device_ ? device_->device().bytes_read() : 0; }

void Engine::place(const StepTable& table, std::size_t step) {
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].pose = table.poses[step * parts.size() + k];
}

/// Steps of a batch from `first` on, for which the wall list holds.
std::size_t Engine::steps_in_margin(const StepTable& table, std::size_t first) {
  std::size_t end = first;
  const std::size_t most = std::min(table.time.size(), first + OnDevice::kBatch);
  for (; end < most; ++end) {
    place(table, end);
    if (parts_left_margin()) break;
  }
  place(table, first);
  return end - first;
}

std::size_t Engine::run(const StepTable& table, double dt, GuardReport& report) {
  std::size_t done = 0;
  bool drifted = false, spoken = false;
  while (done < table.time.size() && !spoken) {
    // As begin and finish do: verlet moves particles before the parts get their poses.
    const bool starts = options.verlet && !drifted;
    if (starts && stale_) rebuild(dt, count_changed_);
    place(table, done);
    if (!starts) rebuild_if_stale(dt);
    const double start = now_seconds();
    const std::size_t steps = drifted ? 1 : steps_in_margin(table, done);
    const OnDevice::Outcome out = steps == 0 ? device_->drift(dt) : device_->run(table, done, steps, drifted, dt);
    if (out.missing_law != 0) {
      const std::uint32_t pair = out.missing_law - 1;
      missing_law(pair / material_count, pair % material_count);
    }
    done += out.done;
    drifted = out.drifted;
    stale_ |= out.stale;
    spoken = out.spoken;
    times_.contacts += now_seconds() - start;
  }
  if (done > 0) {
    place(table, done - 1);
    time_ = table.time[done - 1];
  }
  if (!spoken) return done;
  device_->fetch();
  device_->fetch_sums();
  for (auto& r : results_) {
    r.bad = false;
    r.outside.clear();
  }
  for (std::size_t c = 0; c < results_.size(); ++c) guard_each(c);
  report = guard_report(worst_);
  return done;
}

}  // namespace calx
