// stokes_drag.cpp: drag of a fluid that moves uniformly and does not feel the particles, calx.stokes-drag.
// A few operations per particle and step; + - * / and sqrt only, so every machine gives the same bits.
#include <calx/plugin.hpp>
#include <cstddef>
#include <cstring>

#define CALX_BITS 64
#include <calx/law/prelude.h>
#include "stokes_drag.law.h"
#include <calx/law/force_native.h>
CALX_FORCE_BATCH(stokes_drag)

namespace {

const char source[] = {
#include "stokes_drag.law.h.inc"
};
const char sha256[] =
#include "stokes_drag.law.h.sha256.inc"
    ;

const calx_field fields[] = {
    {"viscosity", "Pa s", "dynamic viscosity of the fluid; preset: air at 20 degrees C", 0, 1e6, 1.81e-5, 0, 0},
    {"correction", "none|schiller-naumann", "Stokes' law alone, or with inertia of the fluid", 0, 1, 0,
     CALX_FIELD_CHOICE, 0},
    {"fluid_density", "kg/m^3", "density of the fluid, for the Reynolds number of the correction", 0, 1e5, 1.204, 0, 0},
    {"fluid_velocity_x", "m/s", "velocity of the fluid, x", -1e5, 1e5, 0, CALX_VEC(1), 0},
    {"fluid_velocity_y", "m/s", "velocity of the fluid, y", -1e5, 1e5, 0, CALX_VEC(1), 0},
    {"fluid_velocity_z", "m/s", "velocity of the fluid, z", -1e5, 1e5, 0, CALX_VEC(1), 0}};

class StokesDrag : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  StokesDrag(const calx_host*, const calx_config& c) {
    row_.viscosity = calx::parameter(descriptor, c, "viscosity");
    row_.corrected = calx::parameter(descriptor, c, "correction");
    row_.density = calx::parameter(descriptor, c, "fluid_density");
    row_.ux = calx::parameter(descriptor, c, "fluid_velocity_x");
    row_.uy = calx::parameter(descriptor, c, "fluid_velocity_y");
    row_.uz = calx::parameter(descriptor, c, "fluid_velocity_z");
    if (row_.corrected > 0.5 && !(row_.viscosity > 0))
      throw calx::ConfigError(
          "viscosity: 0 Pa s gives no Reynolds number; with \"schiller-naumann\" it must be positive");
  }

  const void* get_interface(const char* id) const override {
    static const calx_particle_force table = {
        sizeof(calx_particle_force), CALX_ABI_DRAFT, &eval,   1, kRow, stokes_drag_row_fields, "stokes_drag", source,
        sizeof source - 1,           sha256,         &numbers};
    return std::strcmp(id, CALX_PARTICLE_FORCE) == 0 ? &table : nullptr;
  }

 private:
  static const uint32_t kRow = offsetof(stokes_drag_row_f64, calx_unused) / sizeof(double);
  static const double* row_of(const calx_instance* self) {
    return &static_cast<const StokesDrag*>(self)->row_.viscosity;
  }
  static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) noexcept {
    stokes_drag_batch(row_of(self), block);
  }
  static void CALX_CALL numbers(const calx_instance* self, double* row) noexcept {
    std::memcpy(row, row_of(self), kRow * sizeof *row);
  }

  stokes_drag_row_f64 row_;
};

const calx_descriptor StokesDrag::descriptor = {
    sizeof(calx_descriptor),
    0,
    "calx.stokes-drag",
    CALX_PARTICLE_FORCE,
    "Fluid drag",
    "1.0.0",
    "Calx",
    "Apache-2.0",
    "Drag of a uniformly moving fluid on each particle, as on a sphere of equal volume.",
    0,
    fields,
    sizeof fields / sizeof fields[0],
    0,
    0};

}  // namespace

CALX_PLUGIN(StokesDrag)
