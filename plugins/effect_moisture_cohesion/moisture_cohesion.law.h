/* moisture_cohesion.law.h: pull of liquid bridges that grows with time, a term after any contact law. Equation and
 * symbols: README.md. */
#define moisture_cohesion_pair_LIST(X)                                                            \
  X(tension, "N/m", 0, 10, 0, 0, "surface tension times cosine of the contact angle, once moist") \
  X(time, "s", 0, 1e9, 0, 0, "time over which it rises to that, linearly; 0: from the start")
#define moisture_cohesion_prop_LIST(X)
#define moisture_cohesion_state_LIST(X)
#define moisture_cohesion_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_R_EFF)

CALX_LAW_DECLARE(moisture_cohesion)

CALX_LAW_EVAL(moisture_cohesion) {
  const real rise = R(1.0) / calx_max(p->time, R(1e-30));
  const real share = p->time > R(0.0) ? calx_min(c->time * rise, R(1.0)) : R(1.0);
  const real before = p->time > R(0.0) ? calx_min(calx_max(c->time - c->dt, R(0.0)) * rise, R(1.0)) : R(1.0);
  const real full = R(12.566370614359172) * c->r_eff * p->tension; /* 4 pi R* gamma cos(theta) */
  const real pull = full * share;
  out->fx = -pull * c->nx;
  out->fy = -pull * c->ny;
  out->fz = -pull * c->nz;
  out->elastic = -pull * c->overlap;
  /* The well gets deeper while the pull grows: what falls into it is lost. */
  out->plastic = (pull - full * before) * c->overlap;
}
