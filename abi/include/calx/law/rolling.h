/* SPDX-License-Identifier: MIT
 * calx/law/rolling.h: rolling resistance, written in the law dialect and shared by several laws. Include after prelude.h,
 * once per precision; a host puts its text after that of sliding.h.
 *
 * All models act on the part of the relative spin that lies in the contact plane and are capped at
 * rolling_friction * R* * F_n. They differ in what lies below the cap, so one text with seven numbers serves them:
 *
 *   a      no spring: the full torque against the spin. Near rest it is limited to what brakes the pair within a few
 *          steps, so that it does not chatter.
 *   cdt    as a, but the torque lies along the whole relative spin and only its part in the contact plane acts: a contact
 *          that twists as well is braked less (LIGGGHTS)
 *   epsd   spring 2.25 rolling_friction^2 k_n R*^2 and dashpot 2 eta sqrt(I_r k_r): "type C", holds piles at rest
 *   epsd2  spring k_t R*^2, no dashpot
 *   sds    spring k_r R*^2 and dashpot gamma_r R*^2, both given
 *
 * Sources: Ai, Chen, Rotter, Ooi 2011, Powder Technol. 206, 269 (a, epsd); Iwashita, Oda 1998 (epsd2); Luding 2008,
 * Granular Matter 10, 235 (sds). */
#define calx_rolling_pair_LIST(X)                                                                     \
  X(rolling_friction, "1", 0, 10, 0, 0, "largest rolling torque over normal force and effective radius") \
  X(roll_of_kn, "1", 0, 1e3, 0, 0, "share of the normal stiffness in the rolling spring")              \
  X(roll_of_kt, "1", 0, 1e3, 0, 0, "share of the tangential stiffness in the rolling spring")          \
  X(roll_k, "N/m", 0, 1e15, 0, 0, "rolling stiffness given outright")                                  \
  X(roll_c, "kg/s", 0, 1e15, 0, 0, "rolling dashpot given outright")                                   \
  X(roll_eta, "1", 0, 100, 0, 0, "rolling dashpot over the critical one")                              \
  X(roll_type_a, "1", 0, 2, 0, 0, "1: constant torque against the rolling spin, no spring; 2: against the whole spin")
/* The seven numbers of a pair row, as calx_roll takes them. */
#define CALX_ROLLING(p)                                                                                    \
  p->rolling_friction, p->roll_of_kn, p->roll_of_kt, p->roll_k, p->roll_c, p->roll_eta, p->roll_type_a
#define calx_rolling_state_LIST(X)                                                              \
  X(roll_x, "rad", -10, 10, 0, CALX_FIELD_ODD | CALX_VEC(2), "elastic rolling angle, x")         \
  X(roll_y, "rad", -10, 10, 0, CALX_FIELD_ODD | CALX_VEC(2), "elastic rolling angle, y")         \
  X(roll_z, "rad", -10, 10, 0, CALX_FIELD_ODD | CALX_VEC(2), "elastic rolling angle, z")
#define CALX_ROLLING_NEEDS \
  (CALX_NEED_NORMAL | CALX_NEED_SPIN | CALX_NEED_R_EFF | CALX_NEED_M_EFF | CALX_NEED_R_I | CALX_NEED_R_J)

typedef struct CALX_ID(calx_roller) {
  real x, y, z;                    /* rad, in and out: elastic rolling angle, odd under exchange of i and j */
  real mx, my, mz;                 /* N m, out: moment on i */
  real elastic, friction, damping; /* J, out */
} CALX_ID(calx_roller);

/* kn, kt             N/m, stiffness now; *_before: one step earlier
 * fn                 N, compressive elastic force, not negative */
CALX_FN void CALX_ID(calx_roll)(const CALX_ID(calx_contact) * c, const real rolling_friction, const real of_kn,
                                const real of_kt, const real k_given, const real c_given, const real eta,
                                const real type_a, const real kn, const real kn_before, const real kt,
                                const real kt_before, const real fn, CALX_ID(calx_roller) * s) {
  const real tiny = R(1e-37);
  const real wn = c->wx * c->nx + c->wy * c->ny + c->wz * c->nz;
  const real wx = c->wx - wn * c->nx;
  const real wy = c->wy - wn * c->ny;
  const real wz = c->wz - wn * c->nz;

  const real r2 = c->r_eff * c->r_eff;
  const real kr = (of_kn * kn + of_kt * kt + k_given) * r2;
  const real kr_before = (of_kn * kn_before + of_kt * kt_before + k_given) * r2;
  /* m* r_i r_j is exact for equal spheres and for a wall, where r_j counts as r_i. Radii first: same bits either way. */
  const real mr2 = c->m_eff * (c->r_i * (c->r_j > R(0.0) ? c->r_j : c->r_i));
  const real cr = c_given * r2 + R(2.0) * eta * calx_sqrt(R(1.4) * mr2 * kr);
  /* Type a below its cap: 2/5 m r^2 / dt would stop the spin in one step; an eighth, so that eight contacts may act. */
  const real steady = calx_min(type_a, R(1.0));
  const real brake = steady * R(0.05) * mr2 / calx_max(c->dt, tiny);
  const real roll2 = wx * wx + wy * wy + wz * wz;
  const real share = type_a > R(1.5) ? calx_sqrt(roll2 / calx_max(roll2 + wn * wn, tiny)) : R(1.0);
  const real cap = rolling_friction * c->r_eff * fn * share;
  const real cap2 = cap * cap;

  /* As in calx_slide: carried into the new plane; shrunk while the stiffness grows. */
  const real softer = calx_min(kr_before, kr);
  const real length2 = s->x * s->x + s->y * s->y + s->z * s->z;
  const real sn = s->x * c->nx + s->y * c->ny + s->z * c->nz;
  const real px = s->x - sn * c->nx;
  const real py = s->y - sn * c->ny;
  const real pz = s->z - sn * c->nz;
  const real plane2 = kr * kr * (px * px + py * py + pz * pz);
  const real turn = plane2 > tiny ? calx_sqrt(softer * softer * length2 / calx_max(plane2, tiny)) : R(0.0);
  const real ox = turn * px;
  const real oy = turn * py;
  const real oz = turn * pz;

  const real stretch = (R(1.0) - steady) * c->dt;
  const real tx = ox + stretch * wx;
  const real ty = oy + stretch * wy;
  const real tz = oz + stretch * wz;
  /* As in calx_slide: beyond the cap the spring, or type a's brake, is shortened and the dashpot is off. */
  const real ax = kr * tx + brake * wx;
  const real ay = kr * ty + brake * wy;
  const real az = kr * tz + brake * wz;
  const real trial2 = ax * ax + ay * ay + az * az;
  const real dash = trial2 > cap2 ? R(0.0) : cr;
  const real hx = ax + dash * wx;
  const real hy = ay + dash * wy;
  const real hz = az + dash * wz;
  const real sum2 = hx * hx + hy * hy + hz * hz;
  const real cut = sum2 > cap2 ? cap / calx_sqrt(calx_max(sum2, tiny)) : R(1.0);
  const real slip = trial2 > cap2 ? cut : R(1.0);
  s->x = slip * tx;
  s->y = slip * ty;
  s->z = slip * tz;
  s->mx = -cut * hx;
  s->my = -cut * hy;
  s->mz = -cut * hz;

  const real gx = slip * ax;
  const real gy = slip * ay;
  const real gz = slip * az;
  /* The brake of type a has no force of the step before: its whole torque counts, a spring's by the trapezoid. */
  const real k_old = calx_max(kr, kr_before);
  const real weight = R(0.5) * (R(1.0) + steady);
  const real work = c->dt * (R(0.5) * k_old * (ox * wx + oy * wy + oz * wz) + weight * (gx * wx + gy * wy + gz * wz));
  s->elastic = R(0.5) * kr * (s->x * s->x + s->y * s->y + s->z * s->z);
  s->friction = work - (s->elastic - R(0.5) * kr_before * length2);
  s->damping = -c->dt * ((s->mx + gx) * wx + (s->my + gy) * wy + (s->mz + gz) * wz);
}
