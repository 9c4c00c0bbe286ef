/* my_plugin.law.h: buoyancy, the weight of the fluid that a particle displaces, against gravity. */
#define my_plugin_row_LIST(X)                                        \
  X(density, "kg/m^3", 0, 1e5, 1.2, 0, "density of the fluid")       \
  X(gx, "m/s^2", -1e6, 1e6, 0, 0, "gravity, x")                      \
  X(gy, "m/s^2", -1e6, 1e6, 0, 0, "gravity, y")                      \
  X(gz, "m/s^2", -1e6, 1e6, -9.81, 0, "gravity, z")

CALX_FORCE_DECLARE(my_plugin)

/* b: the particle, p: the numbers above, out: force and moment on it. */
CALX_FORCE_EVAL(my_plugin) {
  const real volume = R(4.18879020478639098) * b->radius * b->radius * b->radius; /* 4 pi / 3 r^3 */
  const real displaced = p->density * volume;
  out->fx = -displaced * p->gx;
  out->fy = -displaced * p->gy;
  out->fz = -displaced * p->gz;
}
