// SPDX-License-Identifier: MIT
// calx/instrument.hpp: optional C++11 helper for instruments; header only. An instrument is a sensor plugin that reads
// the figure of another sensor and gives what is recorded instead: a slow load cell, a scale with a wrong gain.
//
//   class Lag : public calx::instrument::Instrument {
//    public:
//     static const calx_descriptor descriptor;
//     Lag(const calx_host* host, const calx_config& config);      // may throw calx::ConfigError("why")
//     double show(double time, double value) override;            // s, SI; times rise; memory() is kept by checkpoints
//   };
//   const calx_descriptor Lag::descriptor = calx::instrument::descriptor("org.example.lag", "Lag", ..., fields);
//   CALX_PLUGIN(Lag)
#ifndef CALX_INSTRUMENT_HPP
#define CALX_INSTRUMENT_HPP
#include <calx/plugin.hpp>
#include <vector>

namespace calx {
namespace instrument {

class Instrument : public Instance {
 public:
  /// remembered: how many numbers it keeps from call to call, all 0 at first.
  explicit Instrument(std::size_t remembered = 0) : memory_(remembered, 0.0) {}
  virtual double show(double time, double value) = 0;

  const void* get_interface(const char* id) const override {
    static const calx_field output = {"value", "1", "the figure as it is recorded, in its own unit", -1e300, 1e300, 0,
                                      0,       0};
    static const calx_sensor table = {sizeof(calx_sensor), CALX_ABI_DRAFT, &output, 1, 0, &sample};
    static const calx_state state = {sizeof(calx_state), CALX_ABI_DRAFT, 1, 0, &save, &load};
    return std::strcmp(id, CALX_SENSOR) == 0  ? static_cast<const void*>(&table)
           : std::strcmp(id, CALX_STATE) == 0 ? static_cast<const void*>(&state)
                                              : 0;
  }

 protected:
  std::vector<double>& memory() { return memory_; }

 private:
  static calx_status CALX_CALL sample(calx_instance* self, const calx_host* host, const calx_sensor_view* view,
                                      double* out) noexcept {
    if (view->struct_size < sizeof(calx_sensor_view) || view->input_count != 1)
      return host->fail(host, CALX_E_CONFIG,
                        "is an instrument: it reads another sensor; name it under \"instruments\" of that one");
    return guard(host, [&] { *out = static_cast<Instrument*>(self)->show(view->time, view->input[0]); });
  }
  static calx_status CALX_CALL save(const calx_instance* self, const calx_stream* stream) noexcept {
    const std::vector<double>& m = static_cast<const Instrument*>(self)->memory_;
    const uint64_t size = m.size() * sizeof(double);
    return size == 0 || stream->write(stream, m.data(), size) == static_cast<int64_t>(size) ? CALX_OK : CALX_E_IO;
  }
  static calx_status CALX_CALL load(calx_instance* self, const calx_stream* stream, uint32_t schema) noexcept {
    std::vector<double>& m = static_cast<Instrument*>(self)->memory_;
    if (schema != 1) return CALX_E_STATE;
    std::vector<double> numbers(m.size());
    unsigned char* to = reinterpret_cast<unsigned char*>(numbers.data());
    const uint64_t size = m.size() * sizeof(double);
    for (uint64_t done = 0; done < size;) {  // a read may give less than it was asked for
      const int64_t got = stream->read(stream, to + done, size - done);
      if (got <= 0) return CALX_E_STATE;
      done += static_cast<uint64_t>(got);
    }
    m = numbers;
    return CALX_OK;
  }

  std::vector<double> memory_;
};

/// Descriptor of an instrument whose parameters stand in a static array of fields.
template <uint32_t N>
constexpr calx_descriptor descriptor(const char* id, const char* name, const char* version, const char* vendor,
                                     const char* license, const char* summary, const calx_field (&fields)[N]) {
  return calx_descriptor{sizeof(calx_descriptor),
                         0,
                         id,
                         CALX_SENSOR,
                         name,
                         version,
                         vendor,
                         license,
                         summary,
                         nullptr,
                         fields,
                         N,
                         0,
                         nullptr};
}

}  // namespace instrument
}  // namespace calx
#endif
