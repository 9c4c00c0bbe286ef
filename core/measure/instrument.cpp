// instrument.cpp: a sensor behind its instruments, plugins that read the figure it gives and give what is recorded. The
// sensor itself knows nothing of them; it is asked as often as without, so that what is computed stays the same.
#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "measure/listening_host.hpp"
#include "measure/measure.hpp"

namespace calx {
namespace {

class Shown : public Sensor {
 public:
  Shown(std::unique_ptr<Sensor> sensor, const std::vector<InstrumentPlugin>& plugins, const std::string& file)
      : sensor_(std::move(sensor)) {
    name_ = sensor_->name();
    kind_ = sensor_->kind();
    every_ = sensor_->every();
    const std::vector<std::string> columns = sensor_->columns();
    for (const InstrumentPlugin& plugin : plugins) {
      const InstrumentSettings& s = *plugin.settings;
      if (plugin.table->output_count != 1)
        throw Error(Fault::plugin, file + " " + s.pointer + ": " + s.plugin + " gives " +
                                       std::to_string(plugin.table->output_count) +
                                       " numbers, so it is no instrument, which gives one");
      const auto at = s.column.empty() ? columns.begin() : std::find(columns.begin(), columns.end(), s.column);
      if (at == columns.end())
        throw Error(Fault::settings, file + " " + s.pointer + "/column: sensor \"" + name_ + "\" has no column \"" +
                                         s.column + "\"; " + did_you_mean(s.column, columns));
      stages_.push_back({plugin, ListeningHost(plugin.host), static_cast<std::size_t>(at - columns.begin())});
    }
  }

  std::vector<std::string> columns() const override { return sensor_->columns(); }
  bool wants_every_step() const override { return sensor_->wants_every_step(); }
  void step(const WorldView& world) override { sensor_->step(world); }
  bool row_due() const override { return sensor_->row_due(); }
  std::string reason() const override { return sensor_->reason(); }
  std::vector<FieldResult> fields() const override { return sensor_->fields(); }
  std::vector<CurveResult> curves() const override { return sensor_->curves(); }

  std::vector<double> sample(const WorldView& world) override {
    std::vector<double> row = sensor_->sample(world);
    for (Stage& stage : stages_) {
      calx_sensor_view view{};
      view.struct_size = sizeof view;
      view.time = world.time();
      view.input = &row[stage.column];
      view.input_count = 1;
      double shown = 0;
      stage.host.message.clear();
      const calx_status status = stage.plugin.table->sample(stage.plugin.instance, &stage.host.base, &view, &shown);
      if (status != CALX_OK)
        throw Error(Fault::plugin, "instrument " + stage.plugin.settings->plugin + " of sensor \"" + name_ +
                                       "\" failed at t = " + std::to_string(world.time()) + " s: status " +
                                       std::to_string(status) +
                                       (stage.host.message.empty() ? "" : ", " + stage.host.message));
      row[stage.column] = shown;
    }
    return row;
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    sensor_->save(out, prefix);
    for (std::size_t k = 0; k < stages_.size(); ++k) {
      const InstrumentPlugin& plugin = stages_[k].plugin;
      if (!plugin.state) continue;
      std::vector<std::uint8_t> bytes;
      const calx_stream stream = {sizeof(calx_stream), 0, &bytes, &write_bytes, &read_none};
      if (plugin.state->save(plugin.instance, &stream) < 0) throw state_fault(plugin, "saved");
      out.put(place(prefix, k), bytes.data(), bytes.size());
    }
  }
  void load(const StateReader& in, const std::string& prefix) override {
    sensor_->load(in, prefix);
    for (std::size_t k = 0; k < stages_.size(); ++k) {
      const InstrumentPlugin& plugin = stages_[k].plugin;
      if (!plugin.state) continue;
      Reading reading{in.get_u8(place(prefix, k)), 0};
      const calx_stream stream = {sizeof(calx_stream), 0, &reading, &write_none, &read_bytes};
      if (plugin.state->load(plugin.instance, &stream, plugin.state->schema) < 0) throw state_fault(plugin, "read");
    }
  }

 private:
  struct Stage {
    InstrumentPlugin plugin;
    ListeningHost host;
    std::size_t column;
  };
  struct Reading {
    std::vector<std::uint8_t> bytes;
    std::size_t at;
  };

  static std::string place(const std::string& prefix, std::size_t k) {
    return prefix + "/instruments/" + std::to_string(k);
  }
  Error state_fault(const InstrumentPlugin& plugin, const std::string& what) const {
    return Error(Fault::plugin,
                 "instrument " + plugin.settings->plugin + " of sensor \"" + name_ + "\": its state cannot be " + what);
  }
  static std::int64_t CALX_CALL write_bytes(const calx_stream* stream, const void* bytes, std::uint64_t size) noexcept {
    auto& to = *static_cast<std::vector<std::uint8_t>*>(stream->self);
    try {
      const auto* from = static_cast<const std::uint8_t*>(bytes);
      to.insert(to.end(), from, from + size);
    } catch (...) {
      return CALX_E_MEMORY;
    }
    return static_cast<std::int64_t>(size);
  }
  static std::int64_t CALX_CALL read_bytes(const calx_stream* stream, void* bytes, std::uint64_t size) noexcept {
    Reading& from = *static_cast<Reading*>(stream->self);
    const std::size_t n = std::min<std::size_t>(size, from.bytes.size() - from.at);
    if (n > 0) std::memcpy(bytes, from.bytes.data() + from.at, n);
    from.at += n;
    return static_cast<std::int64_t>(n);
  }
  static std::int64_t CALX_CALL write_none(const calx_stream*, const void*, std::uint64_t) noexcept {
    return CALX_E_IO;
  }
  static std::int64_t CALX_CALL read_none(const calx_stream*, void*, std::uint64_t) noexcept { return CALX_E_IO; }

  std::unique_ptr<Sensor> sensor_;
  std::vector<Stage> stages_;
};

}  // namespace

std::unique_ptr<Sensor> with_instruments(std::unique_ptr<Sensor> sensor, const std::vector<InstrumentPlugin>& plugins,
                                         const std::string& file) {
  return std::make_unique<Shown>(std::move(sensor), plugins, file);
}

}  // namespace calx
