/* linear.law.h: linear normal spring and dashpot, linear tangential spring with history, Coulomb limit.
 * Two laws: linear_spring (3 history values, no spin) and linear_spring_rolling (6, with rolling resistance).
 * Columns: name, unit, lowest, highest, preset, flags, meaning. Equations and symbols: README.md. */
#define linear_spring_pair_LIST(X)                                                                             \
  X(kn, "N/m", 0, 1e15, 1e4, 0, "normal stiffness")                                                             \
  X(kt, "N/m", 0, 1e15, 1e4, 0, "tangential stiffness")                                                         \
  X(dash_n, "kg^0.5/s", 0, 1e8, 0, 0, "normal dashpot over the root of the mass: 2 zeta sqrt(kn)")           \
  X(dash_t, "kg^0.5/s", 0, 1e8, 0, 0, "tangential dashpot over the root of the mass")                        \
  X(rate_n, "1/s", 0, 1e12, 0, 0, "normal dashpot over the mass")                                               \
  X(rate_t, "1/s", 0, 1e12, 0, 0, "tangential dashpot over the mass")                                           \
  X(given_n, "kg/s", 0, 1e12, 0, 0, "normal dashpot given outright")                                            \
  X(given_t, "kg/s", 0, 1e12, 0, 0, "tangential dashpot given outright")                                        \
  X(friction, "1", 0, 10, 0.5, 0, "sliding friction")                                                           \
  X(lowest, "N", -1e30, 0, -1e30, 0, "lowest normal force: 0 where tension is clipped, else far below any force") \
  calx_rolling_pair_LIST(X)
#define linear_spring_prop_LIST(X)
#define linear_spring_state_LIST(X)                                                                  \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x")                    \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y")                    \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define linear_spring_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_M_EFF)

#define linear_spring_rolling_pair_LIST(X) linear_spring_pair_LIST(X)
#define linear_spring_rolling_prop_LIST(X) linear_spring_prop_LIST(X)
#define linear_spring_rolling_state_LIST(X) linear_spring_state_LIST(X) calx_rolling_state_LIST(X)
#define linear_spring_rolling_NEEDS (linear_spring_NEEDS | CALX_ROLLING_NEEDS)

CALX_LAW_DECLARE(linear_spring)
CALX_LAW_DECLARE_LIKE(linear_spring_rolling, linear_spring)

/* Force and history of both laws. */
CALX_FN void CALX_ID(linear_spring_force)(const CALX_ID(calx_contact) * c, const CALX_ID(linear_spring_pair) * p,
                                          CALX_ID(calx_spring) * spring, CALX_ID(calx_wrench) * out) {
  const real overlap = calx_max(c->overlap, R(0.0));
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real root = calx_sqrt(c->m_eff);
  const real cn = p->dash_n * root + p->rate_n * c->m_eff + p->given_n;
  const real ct = p->dash_t * root + p->rate_t * c->m_eff + p->given_t;
  const real elastic = p->kn * overlap;
  const real fn = calx_max(elastic - cn * vn, p->lowest);

  /* The tangential stiffness is constant: the spring keeps its length from step to step. */
  CALX_ID(calx_slide)(c, vn, p->kt, p->kt, R(1.0), R(1.0), ct, p->friction * calx_max(fn, R(0.0)), spring);
  out->fx = fn * c->nx + spring->fx;
  out->fy = fn * c->ny + spring->fy;
  out->fz = fn * c->nz + spring->fz;

  out->elastic = R(0.5) * elastic * overlap + spring->elastic;
  out->friction = spring->friction;
  /* The dashpot works on the mean velocity of the step, which the force of this contact changes by fn dt / m*. */
  out->damping = (elastic - fn) * (vn + R(0.5) * fn * c->dt / c->m_eff) * c->dt + spring->damping;
}

CALX_LAW_EVAL(linear_spring) {
  CALX_ID(calx_spring) spring;
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(linear_spring_force)(c, p, &spring, out);
  s->spring_x = spring.x;
  s->spring_y = spring.y;
  s->spring_z = spring.z;
}

CALX_LAW_EVAL(linear_spring_rolling) {
  CALX_ID(calx_spring) spring;
  CALX_ID(calx_roller) roll;
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  CALX_ID(linear_spring_force)(c, p, &spring, out);
  s->spring_x = spring.x;
  s->spring_y = spring.y;
  s->spring_z = spring.z;

  roll.x = s->roll_x;
  roll.y = s->roll_y;
  roll.z = s->roll_z;
  CALX_ID(calx_roll)(c, CALX_ROLLING(p), p->kn, p->kn, p->kt, p->kt, p->kn * calx_max(c->overlap, R(0.0)), &roll);
  s->roll_x = roll.x;
  s->roll_y = roll.y;
  s->roll_z = roll.z;
  out->mx = roll.mx;
  out->my = roll.my;
  out->mz = roll.mz;
  out->elastic = out->elastic + roll.elastic;
  out->friction = out->friction + roll.friction;
  out->damping = out->damping + roll.damping;
}
