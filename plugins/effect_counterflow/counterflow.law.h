/* counterflow.law.h: steady upward air through a region, as it acts on the fine powder that a coarse grain stands for.
 * Equation and symbols: README.md. */
#define counterflow_row_LIST(X)                                                         \
  X(min_x, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, x") \
  X(min_y, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, y") \
  X(min_z, "m", -1e9, 1e9, -1e9, CALX_VEC(1), "lowest corner of the box it acts in, z") \
  X(max_x, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, x") \
  X(max_y, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, y") \
  X(max_z, "m", -1e9, 1e9, 1e9, CALX_VEC(2), "highest corner of the box it acts in, z") \
  X(speed, "m/s", -100, 100, 0, 0, "superficial velocity of the air, up positive")      \
  X(size, "m", 1e-7, 1, 1e-4, 0, "diameter of the powder that a grain stands for")      \
  X(viscosity, "Pa s", 0, 1, 1.81e-5, 0, "dynamic viscosity of the air")

CALX_FORCE_DECLARE(counterflow)

CALX_FORCE_EVAL(counterflow) {
  const real in_x = b->x >= p->min_x && b->x <= p->max_x ? R(1.0) : R(0.0);
  const real in_y = b->y >= p->min_y && b->y <= p->max_y ? in_x : R(0.0);
  const real inside = b->z >= p->min_z && b->z <= p->max_z ? in_y : R(0.0);
  const real volume = R(4.1887902047863905) * b->radius * b->radius * b->radius; /* 4/3 pi r^3 */
  out->fz = inside * (R(18.0) * p->viscosity / (p->size * p->size)) * volume * p->speed;
}
