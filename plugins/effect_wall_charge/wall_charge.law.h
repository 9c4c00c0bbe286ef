/* wall_charge.law.h: electrostatic pull of a wall whose charge builds up or leaks away, a term after any contact law.
 * Equation and symbols: README.md. */
#define wall_charge_pair_LIST(X)                                                                     \
  X(start, "Pa", 0, 1e4, 0, 0, "electrostatic pressure sigma^2 / epsilon_0 at the start of the run") \
  X(end, "Pa", 0, 1e4, 0, 0, "electrostatic pressure it tends to")                                   \
  X(time, "s", 0, 1e9, 1, 0, "time after which half of the way is gone")
#define wall_charge_prop_LIST(X)
#define wall_charge_state_LIST(X)
#define wall_charge_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_R_I)

CALX_LAW_DECLARE(wall_charge)

CALX_LAW_EVAL(wall_charge) {
  const real area = R(3.141592653589793) * c->r_i * c->r_i;
  /* A fraction, not an exponential: the same bits on every device. */
  const real earlier = calx_max(c->time - c->dt, R(0.0));
  const real left = p->time / calx_max(p->time + c->time, R(1e-30));
  const real left_before = p->time / calx_max(p->time + earlier, R(1e-30));
  const real pull = area * (p->end + (p->start - p->end) * left);
  const real before = area * (p->end + (p->start - p->end) * left_before);
  out->fx = -pull * c->nx;
  out->fy = -pull * c->ny;
  out->fz = -pull * c->nz;
  out->elastic = -pull * c->overlap;
  out->plastic = (pull - before) * c->overlap;
}
