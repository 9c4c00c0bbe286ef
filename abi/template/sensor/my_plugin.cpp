// my_plugin.cpp: kinetic energy and largest speed of the particles, the sensor org.example.my-plugin.
#include <calx/plugin.hpp>
#include <cmath>

namespace {

// Columns of the series: name, unit, meaning, lowest, highest, preset, flags, 0.
const calx_field outputs[] = {
    {"kinetic_energy", "J", "of the motion of the centres of mass", 0, 1e30, 0, 0, 0},
    {"largest_speed", "m/s", "of a centre of mass; 0 without particles", 0, 1e30, 0, 0, 0}};

class MyPlugin : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host*, const calx_config&) {}

  const void* get_interface(const char* id) const override {
    static const calx_sensor table = {
        sizeof(calx_sensor), CALX_ABI_DRAFT, outputs, sizeof outputs / sizeof outputs[0], 0, &sample};
    return std::strcmp(id, CALX_SENSOR) == 0 ? &table : nullptr;
  }

 private:
  // Particles come in the order of rising id, so sums have the same bits in every run.
  static calx_status CALX_CALL sample(calx_instance*, const calx_host*, const calx_sensor_view* v, double* out) noexcept {
    double energy = 0, fastest = 0;
    for (uint64_t k = 0; k < v->count; ++k) {
      const double speed2 = v->vx[k] * v->vx[k] + v->vy[k] * v->vy[k] + v->vz[k] * v->vz[k];
      energy += 0.5 * v->mass[k] * speed2;
      fastest = std::fmax(fastest, speed2);
    }
    out[0] = energy;
    out[1] = std::sqrt(fastest);
    return CALX_OK;
  }
};

const calx_descriptor MyPlugin::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "org.example.my-plugin",
                                              CALX_SENSOR,
                                              "my-plugin",
                                              "0.1.0",
                                              "Example",
                                              "MIT",
                                              "Kinetic energy and largest speed of the particles.",
                                              nullptr,
                                              nullptr,
                                              0,
                                              0,
                                              nullptr};

}  // namespace

CALX_PLUGIN(MyPlugin)
