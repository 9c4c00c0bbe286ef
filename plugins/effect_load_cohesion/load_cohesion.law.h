/* load_cohesion.law.h: a pull in proportion to the largest force the contact has borne, a term after any contact law.
 * Equation and symbols: README.md. */
#define load_cohesion_pair_LIST(X) \
  X(ratio, "1", 0, 0.5, 0, 0, "pull over the largest normal force the contact has borne")
#define load_cohesion_prop_LIST(X)
#define load_cohesion_state_LIST(X) X(largest, "N", 0, 1e12, 0, 0, "largest normal force so far")
#define load_cohesion_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(load_cohesion)

CALX_LAW_EVAL(load_cohesion) {
  const real before = p->ratio * s->largest;
  s->largest = calx_max(s->largest, c->fn_before);
  const real pull = p->ratio * s->largest;
  out->fx = -pull * c->nx;
  out->fy = -pull * c->ny;
  out->fz = -pull * c->nz;
  out->elastic = -pull * c->overlap;
  out->plastic = (pull - before) * c->overlap;
}
