// my_plugin.cpp: the force my_plugin.law.h as the plugin org.example.my-plugin.
#include <calx/plugin.hpp>
#include <cstddef>
#include <cstring>

#define CALX_BITS 64
#include <calx/law/prelude.h>
#include "my_plugin.law.h"
#include <calx/law/force_native.h>
CALX_FORCE_BATCH(my_plugin)

namespace {

const char source[] = {
#include "my_plugin.law.h.inc"
};
const char sha256[] =
#include "my_plugin.law.h.sha256.inc"
    ;

// What the user gives: name, unit, meaning, lowest, highest, preset, flags, 0.
const calx_field fields[] = {{"fluid_density", "kg/m^3", "density of the fluid", 0, 1e5, 1.2, 0, 0},
                             {"gravity_x", "m/s^2", "as in the case, x", -1e6, 1e6, 0, CALX_VEC(1), 0},
                             {"gravity_y", "m/s^2", "as in the case, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
                             {"gravity_z", "m/s^2", "as in the case, z", -1e6, 1e6, -9.81, CALX_VEC(1), 0}};

class MyPlugin : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  MyPlugin(const calx_host*, const calx_config& c) {
    row_.density = calx::parameter(descriptor, c, "fluid_density");
    row_.gx = calx::parameter(descriptor, c, "gravity_x");
    row_.gy = calx::parameter(descriptor, c, "gravity_y");
    row_.gz = calx::parameter(descriptor, c, "gravity_z");
  }

  const void* get_interface(const char* id) const override {
    static const calx_particle_force table = {
        sizeof(calx_particle_force), CALX_ABI_DRAFT, &eval,  1, kRow, my_plugin_row_fields, "my_plugin", source,
        sizeof source - 1,           sha256,         &numbers};
    return std::strcmp(id, CALX_PARTICLE_FORCE) == 0 ? &table : nullptr;
  }

 private:
  static const uint32_t kRow = offsetof(my_plugin_row_f64, calx_unused) / sizeof(double);
  static const double* row_of(const calx_instance* self) { return &static_cast<const MyPlugin*>(self)->row_.density; }
  static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) noexcept {
    my_plugin_batch(row_of(self), block);
  }
  static void CALX_CALL numbers(const calx_instance* self, double* row) noexcept {
    std::memcpy(row, row_of(self), kRow * sizeof *row);
  }

  my_plugin_row_f64 row_;
};

const calx_descriptor MyPlugin::descriptor = {sizeof(calx_descriptor),
                                              0,
                                              "org.example.my-plugin",
                                              CALX_PARTICLE_FORCE,
                                              "my-plugin",
                                              "0.1.0",
                                              "Example",
                                              "MIT",
                                              "Buoyancy in a fluid at rest.",
                                              nullptr,
                                              fields,
                                              sizeof fields / sizeof fields[0],
                                              0,
                                              nullptr};

}  // namespace

CALX_PLUGIN(MyPlugin)
