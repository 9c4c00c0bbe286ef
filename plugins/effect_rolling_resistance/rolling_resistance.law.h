/* rolling_resistance.law.h: rolling resistance beside any contact law, for grains that are less round than assumed.
 * Equation and symbols: README.md. */
#define rolling_resistance_pair_LIST(X) \
  X(friction, "1", 0, 10, 0, 0, "largest rolling torque over normal force and effective radius")
#define rolling_resistance_prop_LIST(X)
#define rolling_resistance_state_LIST(X) calx_rolling_state_LIST(X)
#define rolling_resistance_NEEDS (CALX_ROLLING_NEEDS | CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(rolling_resistance)

CALX_LAW_EVAL(rolling_resistance) {
  CALX_ID(calx_roller) roll;
  const real fn = calx_max(c->fn_before, R(0.0));
  /* The rolling spring gives way at 0.02 rad, whatever the load: no stiffness of the base law is known here. */
  const real k = p->friction * fn / (R(0.02) * c->r_eff);
  roll.x = s->roll_x;
  roll.y = s->roll_y;
  roll.z = s->roll_z;
  CALX_ID(calx_roll)
  (c, p->friction, R(0.0), R(0.0), k, R(0.0), R(0.3), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), fn, &roll);
  s->roll_x = p->friction > R(0.0) ? roll.x : R(0.0);
  s->roll_y = p->friction > R(0.0) ? roll.y : R(0.0);
  s->roll_z = p->friction > R(0.0) ? roll.z : R(0.0);
  out->mx = roll.mx;
  out->my = roll.my;
  out->mz = roll.mz;
  out->elastic = roll.elastic;
  out->friction = roll.friction;
  out->damping = roll.damping;
}
