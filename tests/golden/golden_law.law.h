/* golden_law.law.h: a spring, and a string that is fastened when two spheres touch and tears at a gap. Made for closed
 * forms, not for powder: columns of every size, history that survives separation, and a reach. */
#define golden_law_pair_LIST(X)                                 \
  X(spring, "N/m", 0, 1e9, 1e3, 0, "stiffness")                 \
  X(pull, "N", 0, 1e3, 1e-4, 0, "tension of the string")        \
  X(length, "m", 0, 1, 1e-4, 0, "gap at which the string tears")
#define golden_law_prop_LIST(X)
#define golden_law_state_LIST(X) \
  X(fastened, "1", 0, 1, 0, CALX_FIELD_KEEP_APART, "1 while the string holds")
#define golden_law_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL)

CALX_LAW_DECLARE(golden_law)

CALX_LAW_EVAL(golden_law) {
  const real touches = c->overlap > R(0.0) ? R(1.0) : R(0.0);
  const real holds = c->overlap > -p->length ? calx_max(s->fastened, touches) : R(0.0);
  const real fn = p->spring * calx_max(c->overlap, R(0.0)) - holds * p->pull;
  s->fastened = holds;
  out->fx = fn * c->nx;
  out->fy = fn * c->ny;
  out->fz = fn * c->nz;
}
