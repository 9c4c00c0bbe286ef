// own_sensor.cpp: a plugin that lives in the program: no library, no manifest, the same tables. It measures the kinetic
// energy of a falling ball, which must be what gravity has done.
#include <calx/embed.hpp>
#include <calx/plugin.hpp>
#include <cmath>
#include <cstdio>

namespace {

const calx_field outputs[] = {{"energy", "J", "kinetic energy of translation", 0, 1e12, 0, 0, 0}};

class KineticEnergy : public calx::Instance {
 public:
  static const calx_descriptor descriptor;
  KineticEnergy(const calx_host*, const calx_config&) {}
  const void* get_interface(const char* id) const override {
    static const calx_sensor table = {sizeof(calx_sensor), CALX_ABI_DRAFT, outputs, 1, 0, &sample};
    return std::strcmp(id, CALX_SENSOR) == 0 ? &table : 0;
  }

 private:
  static calx_status CALX_CALL sample(calx_instance*, const calx_host*, const calx_sensor_view* v,
                                      double* out) noexcept {
    out[0] = 0;
    for (uint64_t k = 0; k < v->count; ++k)
      out[0] += 0.5 * v->mass[k] * (v->vx[k] * v->vx[k] + v->vy[k] * v->vy[k] + v->vz[k] * v->vz[k]);
    return CALX_OK;
  }
};

const calx_descriptor KineticEnergy::descriptor = {sizeof(calx_descriptor),
                                                   0,
                                                   "org.example.kinetic-energy",
                                                   CALX_SENSOR,
                                                   "Kinetic energy",
                                                   "1.0.0",
                                                   "Example",
                                                   "MIT",
                                                   "Kinetic energy of translation of all particles.",
                                                   0,
                                                   0,
                                                   0,
                                                   0,
                                                   0};

const char kCase[] = R"({
  "calx": 1, "title": "A ball falls", "domain": {"min": [-1, -1, -2], "max": [1, 1, 1]},
  "time": {"end": 0.2, "step": 1e-5},
  "materials": {"glass": {"density": 2500, "young": 5e6, "poisson": 0.25}},
  "contacts": [{"between": ["glass", "glass"], "law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0.3}}],
  "shapes": {"ball": {"sphere": {"radius": 0.005}}},
  "sources": [{"name": "ball", "shape": "ball", "material": "glass", "positions": [[0, 0, 0]]}],
  "sensors": [{"name": "kinetic", "kind": "org.example.kinetic-energy", "every": 0.1}]
})";

}  // namespace

CALX_PLUGIN(KineticEnergy)

int main() try {
  calx::embed::Options options;
  options.plugins = {&calx_plugin_entry};
  auto sim = calx::embed::Simulation::from_text(kCase, options);
  sim.run_until(0.2);
  const double measured = sim.sample(sim.sensor("kinetic"))[0];
  const double mass = sim.numbers("mass")[0][0], fallen = -sim.numbers("position")[0][2];
  const double expected = mass * 9.81 * fallen;
  std::printf("kinetic energy %.6g mJ, work of gravity %.6g mJ\n", 1e3 * measured, 1e3 * expected);
  // Semi-implicit Euler falls farther than the exact ball by t dt g / 2: 5e-5 of 0.2 m.
  return std::fabs(measured / expected - 1) < 1e-4 ? 0 : 1;
} catch (const calx::embed::Failure& e) {
  std::fprintf(stderr, "own_sensor: %s\n", e.what());
  return 1;
}
