/* bad_spring.law.h: a linear spring with friction, in which bad_law.h lets a bad plugin change one thing. */
#define bad_spring_pair_LIST(X) X(k, "N/m", 0, 1e9, 1e4, 0, "normal stiffness")
#define bad_spring_prop_LIST(X)
#define bad_spring_state_LIST(X) \
  X(tx, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x") \
  X(ty, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y") \
  X(tz, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define bad_spring_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_I)

CALX_LAW_DECLARE(bad_spring)

CALX_LAW_EVAL(bad_spring) {
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real fn = p->k * c->overlap;
  const real sn = s->tx * c->nx + s->ty * c->ny + s->tz * c->nz;
  s->tx = s->tx - sn * c->nx + (c->vx - vn * c->nx) * c->dt;
  s->ty = s->ty - sn * c->ny + (c->vy - vn * c->ny) * c->dt;
  s->tz = s->tz - sn * c->nz + (c->vz - vn * c->nz) * c->dt;
  const real ft = p->k * calx_sqrt(s->tx * s->tx + s->ty * s->ty + s->tz * s->tz);
  const real slip = ft > R(0.5) * fn ? R(0.5) * fn / calx_max(ft, R(1e-30)) : R(1.0);
  s->tx = slip * s->tx;
  s->ty = slip * s->ty;
  s->tz = slip * s->tz;
  out->fx = fn * c->nx - p->k * s->tx;
  out->fy = fn * c->ny - p->k * s->ty;
  out->fz = fn * c->nz - p->k * s->tz;
}
