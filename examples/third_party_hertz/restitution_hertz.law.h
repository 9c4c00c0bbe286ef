/* restitution_hertz.law.h: viscoelastic spheres. Hertz force with the dissipation of Kuwabara and Kono (1987), as derived by
 * Brilliantov et al., Phys. Rev. E 53 (1996) 5382: F = k (d^1.5 + 1.5 A sqrt(d) d'), k = 4/3 E* sqrt(R*), d overlap. The
 * faster the impact, the more it loses: 1 - e is proportional to speed^0.2 for small losses. Tangentially the
 * no-slip stiffness of Mindlin with history and a Coulomb limit.
 * Columns: name, unit, lowest, highest, preset, flags, meaning. */
#define restitution_hertz_pair_LIST(X)                                            \
  X(two_e, "Pa", 0, 1e14, 1e7, 0, "twice the effective Young's modulus, 2 E*")    \
  X(eight_g, "Pa", 0, 1e14, 1e7, 0, "eight times the effective shear modulus")    \
  X(relaxation, "s", 0, 1, 1e-5, 0, "dissipative time A of the pair")             \
  X(friction, "1", 0, 10, 0.5, 0, "sliding friction")
#define restitution_hertz_prop_LIST(X)
#define restitution_hertz_state_LIST(X)                                                 \
  X(spring_x, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, x")      \
  X(spring_y, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, y")      \
  X(spring_z, "m", -1, 1, 0, CALX_FIELD_ODD | CALX_VEC(1), "tangential spring, z")
#define restitution_hertz_NEEDS \
  (CALX_NEED_OVERLAP | CALX_NEED_NORMAL | CALX_NEED_VELOCITY | CALX_NEED_R_EFF | CALX_NEED_M_EFF)

CALX_LAW_DECLARE(restitution_hertz)

CALX_LAW_EVAL(restitution_hertz) {
  const real overlap = calx_max(c->overlap, R(0.0));
  const real vn = c->vx * c->nx + c->vy * c->ny + c->vz * c->nz; /* m/s, positive when parting */
  const real before = calx_max(overlap + vn * c->dt, R(0.0));    /* m, overlap one step ago */

  /* Contact radius a = sqrt(R* d); the stiffness dF/dd is 2 E* a, and F = 2/3 of stiffness times overlap. */
  const real a = calx_sqrt(c->r_eff * overlap);
  const real stiffness = p->two_e * a;
  const real elastic = R(0.66666666666666667) * stiffness * overlap;
  const real fn = calx_max(elastic - p->relaxation * stiffness * vn, R(0.0)); /* two bodies do not pull */

  const real kt = p->eight_g * a;
  const real kt_before = p->eight_g * calx_sqrt(c->r_eff * before);
  CALX_ID(calx_spring) spring;
  spring.x = s->spring_x;
  spring.y = s->spring_y;
  spring.z = s->spring_z;
  /* A growing contact keeps its force, a shrinking one its displacement: no cycle gains energy. */
  CALX_ID(calx_slide)(c, vn, kt, kt_before, calx_min(before, overlap), overlap, R(0.0), p->friction * fn, &spring);
  s->spring_x = spring.x;
  s->spring_y = spring.y;
  s->spring_z = spring.z;

  out->fx = fn * c->nx + spring.fx;
  out->fy = fn * c->ny + spring.fy;
  out->fz = fn * c->nz + spring.fz;
  out->elastic = R(0.4) * elastic * overlap + spring.elastic;
  out->friction = spring.friction;
  out->damping = (elastic - fn) * vn * c->dt + spring.damping;
}
