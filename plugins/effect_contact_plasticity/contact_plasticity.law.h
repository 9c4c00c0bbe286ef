/* contact_plasticity.law.h: the plastic unloading of the Edinburgh law, without its adhesion, as a correction of a
 * Hertzian contact. Equation and symbols: README.md. */
#define contact_plasticity_pair_LIST(X)                              \
  X(hertz, "Pa", 0, 1e15, 1e7, 0, "4/3 of the effective modulus E*") \
  X(stiffer, "1", 0, 1e4, 0, 0, "unloading over loading stiffness, less 1: plasticity / (1 - plasticity)")
#define contact_plasticity_prop_LIST(X)
#define contact_plasticity_state_LIST(X) X(deepest, "m", 0, 1, 0, 0, "largest overlap so far")
#define contact_plasticity_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF)

CALX_LAW_DECLARE(contact_plasticity)

CALX_LAW_EVAL(contact_plasticity) {
  const real overlap = calx_max(c->overlap, R(0.0));
  const real deepest = calx_max(s->deepest, overlap);
  const real k1 = p->hertz * calx_sqrt(c->r_eff);
  const real elastic = k1 * overlap * calx_sqrt(overlap);
  const real at_deepest = k1 * deepest * calx_sqrt(deepest);
  /* Loading: 0. Unloading: the steeper line k2 (d^1.5 - dp^1.5) less the Hertzian force; no pull below dp. */
  const real f = calx_max(p->stiffer * (elastic - at_deepest), -elastic);
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  s->deepest = deepest;
  out->fx = f * c->nx;
  out->fy = f * c->ny;
  out->fz = f * c->nz;
  /* All work against the correction is booked as plastic; a reloading gives a part of it back. */
  out->plastic = -f * vn * c->dt;
}
