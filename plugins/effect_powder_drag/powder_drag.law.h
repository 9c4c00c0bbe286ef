/* powder_drag.law.h: drag of still air on the fine powder that a coarse grain stands for. Equation and symbols:
 * README.md. */
#define powder_drag_row_LIST(X)                                                \
  X(viscosity, "Pa s", 0, 1, 0, 0, "dynamic viscosity of the air; 0: no drag") \
  X(size, "m", 1e-7, 1, 1e-4, 0, "diameter of the powder that a grain stands for")

CALX_FORCE_DECLARE(powder_drag)

CALX_FORCE_EVAL(powder_drag) {
  const real volume = R(4.1887902047863905) * b->radius * b->radius * b->radius; /* 4/3 pi r^3 */
  const real rate = R(18.0) * p->viscosity / (p->size * p->size) * volume;
  out->fx = -rate * b->vx;
  out->fy = -rate * b->vy;
  out->fz = -rate * b->vz;
}
