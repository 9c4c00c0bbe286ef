// world.hpp (sim): everything a simulation owns, and the read-only faces it shows to events and sensors.
// Private to sim/.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/world.hpp"
#include "plugin/plugin.hpp"
#include "sim/laws.hpp"
#include "sim/simulation.hpp"
#include "sim/source.hpp"
#include "step/engine.hpp"

namespace calx {

/// A part of the case: its plugin, surface and motion. Engine parts stand in the same order.
struct WorldPart {
  InstancePtr instance;
  std::unique_ptr<Surface> surface;
  int motion = -1;
  std::optional<Pose> driven;  // by the program around this simulation, instead of the motion
};

struct World final : WorldView, EventView {
  explicit World(CaseFile file);

  CaseFile input;
  const CaseSettings& c;  // input.settings
  std::unique_ptr<PluginRegistry> registry;
  CaseLaws laws;
  std::vector<WorldPart> walls;
  std::vector<InstancePtr> motion_instances, force_instances, sensor_instances;
  MotionSet motions;
  EventSet events;
  std::vector<Source> sources;
  std::vector<std::unique_ptr<Sensor>> sensors;
  Engine engine;
  std::vector<StepLimit> limits;
  std::string device;  // where steps run, and why there
  bool fast = false;
  std::vector<std::string> messages;
  double dt = 0, now = 0;
  std::uint64_t steps = 0;
  std::vector<MovedLoad> moved_loads;  // for servos; kept so that a step allocates nothing
  std::size_t stage = 0;
  bool ended = false;
  MassLedger ledger;
  double energy_inserted = 0, energy_removed = 0, energy_leaving = 0, kinetic_inserted = 0;

  void say(const std::string& text);
  std::uint32_t part_number(const std::string& name) const;  // 0xFFFFFFFF: none
  const RegionSettings* region(const std::string& name) const;
  void place_parts(double t);
  /// Takes servos to time t with the loads of the last contacts. Throws what PluginInstance::check throws.
  void advance_servos(double t);
  void set_present(const std::string& part, bool present, double t);
  void handle_events(double t);
  void start_stage(std::size_t number, double t);
  void insert_due(double t);
  void leave(const std::vector<std::uint32_t>& ranks);
  double cycles_at(const std::string& motion, double t) const;
  /// Instant of the contacts of a step, s: verlet evaluates them at its end, euler at its start.
  double contact_time(std::uint64_t step) const {
    return static_cast<double>(engine.options.verlet ? step + 1 : step) * dt;
  }
  /// Steps from now on, at most `most`, between which nobody looks at the world: the first is always one of them.
  StepTable steps_alone(std::uint64_t most);
  double potential(std::size_t p) const;

  // WorldView
  const CaseSettings& settings() const override { return c; }
  double time() const override { return now; }
  std::uint64_t step() const override { return steps; }
  double time_step() const override { return dt; }
  const Particles& particles() const override {
    engine.fetch();
    return engine.particles;
  }
  std::size_t part_count() const override { return walls.size(); }
  const std::string& part_name(std::size_t part) const override { return c.parts[part].name; }
  bool part_present(std::size_t part) const override { return engine.parts[part].present; }
  const Surface& part_surface(std::size_t part) const override { return *walls[part].surface; }
  Pose part_pose(std::size_t part) const override;
  PartLoad part_load(std::size_t part) const override {
    engine.fetch_loads();
    return {engine.parts[part].force, engine.parts[part].torque};
  }
  std::vector<ContactRow> contacts() const override;
  std::vector<std::uint32_t> contact_counts() const override;
  EnergyLedger energy() const override;
  MassLedger mass() const override;
  double cycles_of(const std::string& motion) const override;
  double event_time(const std::string& event) const override { return events.time_of(event); }
  bool in_region(const std::string& region, const Vec3& p) const override;
  // EventView
  double mass_in(const std::string& region) const override;
  std::uint64_t count_in(const std::string& region) const override;
  bool settled_in(const std::string& region, double per_particle) const override;
};

}  // namespace calx
