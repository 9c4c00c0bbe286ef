// stokes_drag.cpp: drag of a fluid that moves uniformly and does not feel the particles, calx.stokes-drag.
// A few operations per particle and step; + - * / and sqrt only, so every machine gives the same bits.
#include <calx/plugin.hpp>
#include <cmath>

namespace {

const double pi = 3.14159265358979323846;

const calx_field fields[] = {
    {"viscosity", "Pa s", "dynamic viscosity of the fluid; preset: air at 20 degrees C", 0, 1e6, 1.81e-5, 0, 0},
    {"correction", "none|schiller-naumann", "Stokes' law alone, or with inertia of the fluid", 0, 1, 0,
     CALX_FIELD_CHOICE, 0},
    {"fluid_density", "kg/m^3", "density of the fluid, for the Reynolds number of the correction", 0, 1e5, 1.204, 0, 0},
    {"fluid_velocity_x", "m/s", "velocity of the fluid, x", -1e5, 1e5, 0, CALX_VEC(1), 0},
    {"fluid_velocity_y", "m/s", "velocity of the fluid, y", -1e5, 1e5, 0, CALX_VEC(1), 0},
    {"fluid_velocity_z", "m/s", "velocity of the fluid, z", -1e5, 1e5, 0, CALX_VEC(1), 0}};

// Re^0.687 as Re^(1/2 + 1/8 + 1/16 - 1/2048) by square roots: the exponent is 0.687012, and below Re = 1e5 the power is
// off by less than 2e-4, against some 5 % of the correlation itself.
double power_0687(double re) {
  const double half = std::sqrt(re), eighth = std::sqrt(std::sqrt(half)), sixteenth = std::sqrt(eighth);
  double small = sixteenth;
  for (int k = 0; k < 7; ++k) small = std::sqrt(small);
  return half * eighth * sixteenth / small;
}

class StokesDrag : public calx::Instance {
 public:
  static const calx_descriptor descriptor;

  StokesDrag(const calx_host*, const calx_config& c)
      : viscosity_(calx::parameter(descriptor, c, "viscosity")),
        density_(calx::parameter(descriptor, c, "fluid_density")),
        ux_(calx::parameter(descriptor, c, "fluid_velocity_x")),
        uy_(calx::parameter(descriptor, c, "fluid_velocity_y")),
        uz_(calx::parameter(descriptor, c, "fluid_velocity_z")),
        corrected_(calx::parameter(descriptor, c, "correction") > 0.5) {
    if (corrected_ && !(viscosity_ > 0))
      throw calx::ConfigError(
          "viscosity: 0 Pa s gives no Reynolds number; with \"schiller-naumann\" it must be positive");
  }

  const void* get_interface(const char* id) const override {
    static const calx_particle_force table = {sizeof(calx_particle_force), CALX_ABI_DRAFT, &eval};
    return std::strcmp(id, CALX_PARTICLE_FORCE) == 0 ? &table : 0;
  }

 private:
  // Measured over Stokes drag: 1 + 0.15 Re^0.687 (Schiller and Naumann 1933), and beyond its end near Re = 1000 the
  // constant drag coefficient 0.44 of a sphere, 0.44 Re / 24.
  double factor(double radius, double speed) const {
    const double re = 2 * radius * density_ * speed / viscosity_;
    if (!(re > 0)) return 1;
    const double naumann = 1 + 0.15 * power_0687(re), newton = 0.44 / 24 * re;
    return naumann > newton ? naumann : newton;
  }
  static void CALX_CALL eval(const calx_instance* instance, const calx_particle_block* b) noexcept {
    const StokesDrag& self = *static_cast<const StokesDrag*>(instance);
    for (uint32_t k = 0; k < b->count; ++k) {
      const double vx = b->vx[k] - self.ux_, vy = b->vy[k] - self.uy_, vz = b->vz[k] - self.uz_;
      double c = 6 * pi * self.viscosity_ * b->radius[k];
      if (self.corrected_) c *= self.factor(b->radius[k], std::sqrt(vx * vx + vy * vy + vz * vz));
      b->fx[k] -= c * vx;
      b->fy[k] -= c * vy;
      b->fz[k] -= c * vz;
    }
  }

  double viscosity_, density_, ux_, uy_, uz_;
  bool corrected_;
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
