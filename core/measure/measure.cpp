// measure.cpp: the one place that makes built-in sensors.
#include "measure/measure.hpp"

#include "base/error.hpp"
#include "measure/kinds.hpp"

namespace calx {

namespace {

struct Kind {
  const char* name;
  std::unique_ptr<Sensor> (*make)(SensorOptions&);
};

const Kind kinds[] = {{"mass", make_mass_sensor},
                      {"cycle-mass", make_cycle_mass_sensor},
                      {"flow", make_flow_sensor},
                      {"bulk-density", make_bulk_density_sensor},
                      {"coordination", make_coordination_sensor},
                      {"height-map", make_height_map_sensor},
                      {"angle-of-repose", make_angle_of_repose_sensor},
                      {"discharge", make_discharge_sensor},
                      {"drum-surface", make_drum_surface_sensor},
                      {"inertial-number", make_inertial_number_sensor},
                      {"residue", make_residue_sensor},
                      {"part-load", make_part_load_sensor},
                      {"stress", make_stress_sensor},
                      {"cell-density", make_cell_density_sensor},
                      {"wall-friction", make_wall_friction_sensor},
                      {"yield-locus", make_yield_locus_sensor},
                      {"energy", make_energy_sensor},
                      {"mass-ledger", make_mass_ledger_sensor}};

const Kind* find_kind(const std::string& name) {
  for (const Kind& kind : kinds)
    if (name == kind.name) return &kind;
  return nullptr;
}

}  // namespace

std::unique_ptr<Sensor> make_sensor(const SensorSettings& settings, const CaseSettings& world) {
  const Kind* kind = find_kind(settings.kind);
  if (!kind)
    throw Error(Fault::settings, world.file + " " + settings.pointer + "/kind: " + unknown_sensor_kind(settings.kind));
  SensorOptions options(settings, world);
  std::unique_ptr<Sensor> sensor = kind->make(options);
  options.finish();
  sensor->name_ = settings.name;
  sensor->kind_ = settings.kind;
  sensor->every_ = settings.every;
  return sensor;
}

}  // namespace calx
