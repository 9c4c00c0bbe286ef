/* stokes_drag.law.h: drag of a fluid that moves uniformly and does not feel the particles. Equations: README.md. */
#define stokes_drag_row_LIST(X)                                                                    \
  X(viscosity, "Pa s", 0, 1e6, 1.81e-5, 0, "dynamic viscosity of the fluid")                       \
  X(corrected, "1", 0, 1, 0, 0, "1: with inertia of the fluid, 0: Stokes' law alone")              \
  X(density, "kg/m^3", 0, 1e5, 1.204, 0, "density of the fluid")                                   \
  X(ux, "m/s", -1e5, 1e5, 0, 0, "velocity of the fluid, x")                                        \
  X(uy, "m/s", -1e5, 1e5, 0, 0, "velocity of the fluid, y")                                        \
  X(uz, "m/s", -1e5, 1e5, 0, 0, "velocity of the fluid, z")

CALX_FORCE_DECLARE(stokes_drag)

CALX_FORCE_EVAL(stokes_drag) {
  const real vx = b->vx - p->ux;
  const real vy = b->vy - p->uy;
  const real vz = b->vz - p->uz;
  /* Over Stokes drag: 1 + 0.15 Re^0.687 (Schiller and Naumann 1933), and beyond its end near Re = 1000 the constant drag
   * coefficient 0.44 of a sphere, 0.44 Re / 24. */
  const real re = R(2.0) * b->radius * p->density * calx_sqrt(vx * vx + vy * vy + vz * vz) / p->viscosity;
  /* Re^0.687 as Re^(1/2 + 1/8 + 1/16 - 1/2048) by square roots: the exponent is 0.687012, and below Re = 1e5 the power
   * is off by less than 2e-4, against some 5 % of the correlation itself. */
  const real part2 = calx_sqrt(re);
  const real part8 = calx_sqrt(calx_sqrt(part2));
  const real part16 = calx_sqrt(part8);
  const real part256 = calx_sqrt(calx_sqrt(calx_sqrt(calx_sqrt(part16))));
  const real part2048 = calx_sqrt(calx_sqrt(calx_sqrt(part256)));
  const real naumann = R(1.0) + R(0.15) * (part2 * part8 * part16 / part2048);
  const real newton = R(0.44) / R(24.0) * re;
  const real factor = re > R(0.0) ? calx_max(naumann, newton) : R(1.0);
  const real stokes = R(18.84955592153876) * p->viscosity * b->radius; /* 6 pi eta r */
  const real c = p->corrected > R(0.5) ? stokes * factor : stokes;
  out->fx = -c * vx;
  out->fy = -c * vy;
  out->fz = -c * vz;
}
