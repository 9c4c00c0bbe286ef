/* vent_pressure.law.h: upward pressure gradient of air that leaves a pocket as it opens, in pulses. Equation and
 * symbols: README.md. */
#define vent_pressure_row_LIST(X)                                                                  \
  X(min_x, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, x")            \
  X(min_y, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, y")            \
  X(min_z, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, z")            \
  X(max_x, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, x")            \
  X(max_y, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, y")            \
  X(max_z, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, z")            \
  X(gradient, "Pa/m", 0, 1e6, 0, 0, "pressure gradient at the start of a pulse, lifting along +z") \
  X(period, "s", 1e-6, 1e9, 0.28, 0, "time between two pulses")                                    \
  X(vent, "s", 1e-9, 1e9, 0.1, 0, "time in which a pulse falls to nothing, linearly")              \
  X(start, "s", -1e9, 1e9, 0, 0, "time of one pulse")

CALX_FORCE_DECLARE(vent_pressure)

CALX_FORCE_EVAL(vent_pressure) {
  /* Nearest whole number by adding and taking away 1.5 * 2^52: the dialect has no floor, and this is exact in doubles.
   */
  const real turns = (b->time - p->start) / p->period;
  const real whole = (turns + R(6755399441055744.0)) - R(6755399441055744.0);
  const real rest = turns - whole;
  const real phase = (rest < R(0.0) ? rest + R(1.0) : rest) * p->period;
  const real pulse = calx_max(R(1.0) - phase / p->vent, R(0.0));
  const real in_x = b->x >= p->min_x && b->x <= p->max_x ? R(1.0) : R(0.0);
  const real in_y = b->y >= p->min_y && b->y <= p->max_y ? in_x : R(0.0);
  const real inside = b->z >= p->min_z && b->z <= p->max_z ? in_y : R(0.0);
  const real volume = R(4.1887902047863905) * b->radius * b->radius * b->radius; /* 4/3 pi r^3 */
  out->fz = inside * volume * p->gradient * pulse;
}
