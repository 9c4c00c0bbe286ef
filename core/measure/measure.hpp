// measure.hpp: sensors: built-in kinds and plugins ("calx.sensor/1") behind one interface.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/state.hpp"
#include "calx/sensor.h"
#include "calx/state.h"
#include "config/sensor_kinds.hpp"
#include "measure/world.hpp"

namespace calx {

/// A grid of numbers a sensor can give beside its series (pile height map), row by row, y outer.
struct FieldResult {
  std::string name, unit;
  std::size_t nx = 0, ny = 0;
  Vec3 origin;                 // m, corner of the first cell
  double cell = 0;             // m
  std::vector<double> values;  // NaN where nothing is
};

/// A curve (pile profile).
struct CurveResult {
  std::string name, x_name, y_name;  // names end in their unit: "x_m", "height_m"
  std::vector<double> x, y;
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  const std::string& name() const { return name_; }
  const std::string& kind() const { return kind_; }
  double every() const { return every_; }
  /// Column names with units, without time: "mass_kg".
  virtual std::vector<std::string> columns() const = 0;
  /// One row. May keep state between calls (flow, cycles); called at rising times.
  virtual std::vector<double> sample(const WorldView& world) = 0;
  /// Called after every step when it asks for it (flow through a plane, cycle masses): cheap, no allocation.
  virtual bool wants_every_step() const { return false; }
  virtual void step(const WorldView&) {}
  /// True when step() saw something that deserves a row at once, beside the regular ones; sample() clears it.
  virtual bool row_due() const { return false; }
  /// Why the figure of the last row is not a number, as a sentence without its full stop; empty when it is one.
  virtual std::string reason() const { return {}; }
  virtual std::vector<FieldResult> fields() const { return {}; }
  virtual std::vector<CurveResult> curves() const { return {}; }
  virtual void save(StateWriter&, const std::string& /*prefix*/) const {}
  virtual void load(const StateReader&, const std::string& /*prefix*/) {}

 protected:
  std::string name_, kind_;
  double every_ = 0;
  friend std::unique_ptr<Sensor> make_sensor(const SensorSettings&, const CaseSettings&);
};

/// Built-in kinds: sensor_kinds(); their makers stand in kinds.hpp. Throws Error(Fault::settings) for an unknown kind
/// (nearest name) or bad keys.
std::unique_ptr<Sensor> make_sensor(const SensorSettings& settings, const CaseSettings& world);
/// A plugin's sensor; table and instance outlive it.
std::unique_ptr<Sensor> make_plugin_sensor(const SensorSettings& settings, const calx_sensor* table,
                                           calx_instance* instance, const calx_host* host);

/// One instrument of a sensor: a plugin that changes one of its columns. Tables and instance outlive it; state may be
/// null.
struct InstrumentPlugin {
  const InstrumentSettings* settings = nullptr;
  const calx_sensor* table = nullptr;
  const calx_state* state = nullptr;
  calx_instance* instance = nullptr;
  const calx_host* host = nullptr;
};
/// The sensor as its instruments show it, in their order: same name, columns, fields and curves. Throws
/// Error(Fault::settings) for a column the sensor lacks, Error(Fault::plugin) for a plugin that is no instrument.
std::unique_ptr<Sensor> with_instruments(std::unique_ptr<Sensor> sensor, const std::vector<InstrumentPlugin>& plugins,
                                         const std::string& file);

}  // namespace calx
