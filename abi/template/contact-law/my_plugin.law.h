/* my_plugin.law.h: linear normal spring and dashpot, tangential spring with history, Coulomb limit.
 * Columns: name, unit, lowest, highest, preset, flags, meaning. */
#define my_plugin_pair_LIST(X)                                   \
  X(kn, "N/m", 1e-3, 1e12, 1e4, 0, "normal stiffness")           \
  X(kt, "N/m", 0, 1e12, 8e3, 0, "tangential stiffness")          \
  X(gn, "kg/s", 0, 1e6, 0.05, 0, "normal damping coefficient")   \
  X(mu, "1", 0, 10, 0.5, 0, "sliding friction")
#define my_plugin_prop_LIST(X)
#define my_plugin_state_LIST(X)                                                 \
  X(tx, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x")    \
  X(ty, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y")    \
  X(tz, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
/* Inputs that the body reads; all others are 0. */
#define my_plugin_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY)

CALX_LAW_DECLARE(my_plugin)

/* c: contact, p: pair row, s: history, out: force on i and energies. */
CALX_LAW_EVAL(my_plugin) {
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz; /* m/s, positive when parting */
  const real fn = calx_max(p->kn * c->overlap - p->gn * vn, R(0.0));

  /* The spring is carried into the new contact plane, then stretched. */
  const real sn = s->tx * c->nx + s->ty * c->ny + s->tz * c->nz;
  const real tx = s->tx - sn * c->nx + (c->vx - vn * c->nx) * c->dt;
  const real ty = s->ty - sn * c->ny + (c->vy - vn * c->ny) * c->dt;
  const real tz = s->tz - sn * c->nz + (c->vz - vn * c->nz) * c->dt;

  /* Both sides of a ternary are computed, so the divisor is kept away from zero. */
  const real ft = p->kt * calx_sqrt(tx * tx + ty * ty + tz * tz);
  const real limit = p->mu * fn;
  const real slip = ft > limit ? limit / calx_max(ft, R(1e-30)) : R(1.0);
  s->tx = slip * tx;
  s->ty = slip * ty;
  s->tz = slip * tz;

  out->fx = fn * c->nx - p->kt * s->tx;
  out->fy = fn * c->ny - p->kt * s->ty;
  out->fz = fn * c->nz - p->kt * s->tz;

  /* J, for the energy ledger of a run. */
  out->elastic = R(0.5) * (p->kn * c->overlap * c->overlap + p->kt * (s->tx * s->tx + s->ty * s->ty + s->tz * s->tz));
  out->friction = (R(1.0) - slip) * slip * ft * ft / calx_max(p->kt, R(1e-30));
  out->damping = (p->kn * c->overlap - fn) * vn * c->dt;
}
