// Two sensors with hidden state: one counts its looks and saves the count; one says it does and saves nothing of it.
#include <calx/plugin.hpp>
#include <cstring>

namespace {

const calx_field outputs[] = {{"looks", "1", "how often it looked", 0, 1e9, 0, 0, 0}};

template <bool Saves>
struct Counter : calx::Instance {
  static const calx_descriptor descriptor;
  Counter(const calx_host*, const calx_config&) {}
  const void* get_interface(const char* id) const override {
    static const calx_sensor sensor = {sizeof(calx_sensor), CALX_ABI_DRAFT, outputs, 1, 0, &sample};
    static const calx_state state = {sizeof(calx_state), CALX_ABI_DRAFT, 1, 0, &save, &load};
    if (std::strcmp(id, CALX_SENSOR) == 0) return &sensor;
    return std::strcmp(id, CALX_STATE) == 0 ? &state : nullptr;
  }
  static calx_status CALX_CALL sample(calx_instance* self, const calx_host*, const calx_sensor_view*, double* out) {
    out[0] = ++static_cast<Counter*>(self)->looks;
    return CALX_OK;
  }
  static calx_status CALX_CALL save(const calx_instance* self, const calx_stream* stream) {
    const double value = Saves ? static_cast<const Counter*>(self)->looks : 0.0;
    return stream->write(stream, &value, sizeof value) == sizeof value ? CALX_OK : CALX_E_IO;
  }
  static calx_status CALX_CALL load(calx_instance* self, const calx_stream* stream, uint32_t schema) {
    if (schema != 1) return CALX_E_STATE;
    char bytes[sizeof(double)];
    for (uint64_t at = 0; at < sizeof bytes;) {
      const int64_t n = stream->read(stream, bytes + at, sizeof bytes - at);
      if (n <= 0) return CALX_E_STATE;
      at += static_cast<uint64_t>(n);
    }
    std::memcpy(&static_cast<Counter*>(self)->looks, bytes, sizeof bytes);
    return CALX_OK;
  }
  double looks = 0;
};

constexpr calx_descriptor described(const char* id) {
  return {sizeof(calx_descriptor), 0,       id,      CALX_SENSOR, "Counter", "1.0.0", "Calx", "Apache-2.0",
          "A plugin for tests.",   nullptr, nullptr, 0,           0,         nullptr};
}
template <>
const calx_descriptor Counter<true>::descriptor = described("test.keeps-state");
template <>
const calx_descriptor Counter<false>::descriptor = described("test.forgets-state");

}  // namespace

CALX_PLUGIN(Counter<true>, Counter<false>)
