// kinds.hpp: the built-in sensors, one maker each. What a kind measures, its keys, units and uncertainty stand at the
// head of the file that implements it.
#pragma once
#include <memory>

#include "measure/measure.hpp"
#include "measure/options.hpp"

namespace calx {

std::unique_ptr<Sensor> make_mass_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_cycle_mass_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_flow_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_bulk_density_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_coordination_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_height_map_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_angle_of_repose_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_discharge_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_drum_surface_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_inertial_number_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_residue_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_part_load_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_stress_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_cell_density_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_wall_friction_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_yield_locus_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_energy_sensor(SensorOptions& options);
std::unique_ptr<Sensor> make_mass_ledger_sensor(SensorOptions& options);

}  // namespace calx
