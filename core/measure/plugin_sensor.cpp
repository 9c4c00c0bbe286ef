// plugin_sensor.cpp: a sensor plugin ("calx.sensor/1") behind the interface of the built-in ones.
// The plugin sees one row per particle in the order of rising id, whatever the order of storage.
#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "measure/listening_host.hpp"
#include "measure/measure.hpp"

namespace calx {

namespace {

/// "angle" in "rad" -> "angle_rad"; "kg/m^3" -> "_kg_m3"; a choice is a plain number.
std::string column_of(const calx_field& field) {
  std::string name = field.name;
  name += '_';
  const std::string unit = (field.flags & CALX_FIELD_CHOICE) != 0 || !field.unit || !*field.unit ? "1" : field.unit;
  for (char c : unit) {
    if (c == '/' || c == '*' || c == ' ')
      name += '_';
    else if (c != '^' && c != '(' && c != ')')
      name += c;
  }
  return name;
}

class PluginSensor : public Sensor {
 public:
  PluginSensor(const SensorSettings& settings, const calx_sensor* table, calx_instance* instance, const calx_host* host)
      : table_(table), instance_(instance), host_(host) {
    name_ = settings.name;
    kind_ = settings.kind;
    every_ = settings.every;
  }
  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    for (std::uint32_t k = 0; k < table_->output_count; ++k) names.push_back(column_of(table_->output[k]));
    return names;
  }

  std::vector<double> sample(const WorldView& world) override {
    gather(world.particles());
    calx_sensor_view view{};
    view.struct_size = sizeof view;
    view.count = id_.size();
    view.time = world.time();
    view.id = id_.data();
    const double** const place[] = {&view.x,  &view.y,  &view.z,  &view.vx,   &view.vy,    &view.vz,
                                    &view.wx, &view.wy, &view.wz, &view.mass, &view.radius};
    for (std::size_t c = 0; c < column_count; ++c) *place[c] = column_[c].data();
    std::vector<double> row(table_->output_count);
    host_.message.clear();
    const calx_status status = table_->sample(instance_, &host_.base, &view, row.data());
    if (status != CALX_OK)
      throw Error(Fault::plugin, "sensor \"" + name_ + "\" (" + kind_ +
                                     ") failed at t = " + std::to_string(world.time()) + " s: status " +
                                     std::to_string(status) + (host_.message.empty() ? "" : ", " + host_.message));
    return row;
  }

 private:
  static constexpr std::size_t column_count = 11;

  void gather(const Particles& particles) {
    std::vector<std::uint32_t> order(particles.count());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
    id_.clear();
    for (std::vector<double>& column : column_) column.clear();
    for (std::uint32_t p : order) {
      const Record& b = particles.body[p];
      const double values[column_count] = {
          b.x, b.y, b.z, b.vx, b.vy, b.vz, b.wx, b.wy, b.wz, b.m, particles.equal_radius(p)};
      id_.push_back(particles.id[p]);
      for (std::size_t c = 0; c < column_count; ++c) column_[c].push_back(values[c]);
    }
  }

  const calx_sensor* table_;
  calx_instance* instance_;
  ListeningHost host_;
  std::vector<std::uint32_t> id_;
  std::vector<double> column_[column_count];
};

}  // namespace

std::unique_ptr<Sensor> make_plugin_sensor(const SensorSettings& settings, const calx_sensor* table,
                                           calx_instance* instance, const calx_host* host) {
  return std::make_unique<PluginSensor>(settings, table, instance, host);
}

}  // namespace calx
