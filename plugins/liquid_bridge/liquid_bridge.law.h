/* liquid_bridge.law.h: a pendular liquid bridge between two spheres or a sphere and a wall: capillary pull against the
 * gap, viscous squeeze, hysteresis of forming and breaking. A term that stands after an elastic law. Equations and
 * symbols: README.md. R = 2 r_eff is the radius that Derjaguin's approximation puts in place of both. */
#define liquid_bridge_pair_LIST(X)                                                                                 \
  X(pull, "N/m", 0, 1e6, 0, 0, "2 pi gamma cos(theta): capillary force over R while touching")                      \
  X(spread, "m^3", 0, 1e9, 0, 0, "2 V / pi of a bridge of given volume")                                            \
  X(spread_share, "1", 0, 1e9, 0, 0, "2 V / (pi R^3) of a bridge in proportion to the size")                        \
  X(rupture, "m", 0, 1e9, 0, 0, "gap at which a bridge of given volume breaks")                                     \
  X(rupture_share, "1", 0, 1e9, 0, 0, "that over R of a bridge in proportion to the size")                          \
  X(formation, "m", 0, 1e9, 0, 0, "gap at which a bridge forms")                                                    \
  X(squeeze, "Pa*s", 0, 1e9, 0, 0, "6 pi times the viscosity")                                                      \
  X(least_gap, "m", 1e-12, 1, 1e-6, 0, "gap below which viscous forces grow no more: roughness")
#define liquid_bridge_prop_LIST(X)
#define liquid_bridge_state_LIST(X) \
  X(bridge, "1", 0, 1, 0, CALX_FIELD_KEEP_APART, "1 while there is a bridge")
#define liquid_bridge_NEEDS                                                                            \
  (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF | \
   CALX_NEED_FN_BEFORE)

CALX_LAW_DECLARE(liquid_bridge)

CALX_LAW_EVAL(liquid_bridge) {
  const real radius = R(2.0) * c->r_eff;
  const real gap = calx_max(-c->overlap, R(0.0));
  const real rupture = p->rupture + p->rupture_share * radius;
  const real forms = gap <= p->formation ? R(1.0) : R(0.0);
  const real wet = calx_max(s->bridge, forms);
  const real bridge = gap < rupture ? wet : R(0.0);

  /* X = 1 - S / sqrt(S^2 + a), a = 2 V / (pi R), written so that nothing cancels at wide gaps. The floor, the square of
   * 1e-10 m, keeps a dry contact from dividing zero by zero. */
  const real a = calx_max((p->spread + p->spread_share * radius * radius * radius) / radius, R(1e-20));
  const real root = calx_sqrt(gap * gap + a);
  const real rest = a / (root + gap); /* sqrt(S^2 + a) - S */
  const real x = rest / root;
  const real strength = bridge * p->pull * radius;

  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz;
  const real dashpot = bridge * p->squeeze * c->r_eff * c->r_eff * x * x / calx_max(gap, p->least_gap);
  const real fn = -strength * x - dashpot * vn;
  out->fx = fn * c->nx;
  out->fy = fn * c->ny;
  out->fz = fn * c->nz;

  /* The capillary pull has a potential, 0 where the bridge breaks and linear while the grains overlap. A bridge that
   * forms falls into it, and what it falls is lost. The dashpot works on the mean velocity of the step. */
  const real root_end = calx_sqrt(rupture * rupture + a);
  const real depth = strength * (rest - a / (root_end + rupture) + calx_max(c->overlap, R(0.0)));
  out->elastic = -depth;
  out->plastic = s->bridge > R(0.5) ? R(0.0) : depth;
  out->damping = dashpot * vn * (vn + R(0.5) * (c->fn_before + fn) * c->dt / c->m_eff) * c->dt;
  s->bridge = bridge;
}
