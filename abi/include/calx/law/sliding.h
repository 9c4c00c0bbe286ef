/* SPDX-License-Identifier: MIT
 * calx/law/sliding.h: tangential spring, dashpot and Coulomb slider, written in the law dialect and shared by several
 * laws. Include after prelude.h, once per precision; a host puts its text after the prelude's.
 *
 * The spring is a displacement vector in the contact plane (m). Each step it is carried into the new plane: projected,
 * then given its old length back. Its stiffness may change with the overlap; the law says, by num and den, whether the
 * force or the displacement is kept then. Force while it grows and displacement while it falls lose energy or keep it, so
 * that no cycle of loading and shearing creates energy (the rule of LAMMPS' mindlin/rescale). */
typedef struct CALX_ID(calx_spring) {
  real x, y, z;                    /* m, in and out: the spring, odd under exchange of i and j */
  real fx, fy, fz;                 /* N, out: tangential force on i */
  real elastic, friction, damping; /* J, out: stored now; lost in this step to sliding; lost to the dashpot */
} CALX_ID(calx_spring);

/* Reads normal, velocity, m_eff and dt of the contact.
 *
 * vn         m/s, normal component of the velocity
 * kt         N/m, stiffness now; kt_before: one step earlier (read by the energy outputs only)
 * num, den   their ratio is (kt_before / kt)^2 where the force is kept, 1 where the displacement is. Given apart, so that
 *            one division serves this and the turn of the spring; den = 0 empties the spring
 * ct         kg/s, dashpot; off while the spring slides, cut where spring and dashpot together exceed the limit
 * limit      N, Coulomb limit, not negative */
CALX_FN void CALX_ID(calx_slide)(const CALX_ID(calx_contact) * c, const real vn, const real kt, const real kt_before,
                                 const real num, const real den, const real ct, const real limit,
                                 CALX_ID(calx_spring) * s) {
  const real tiny = R(1e-37); /* smallest normal float, roughly: below it a square is no longer accurate */
  const real vx = c->vx - vn * c->nx;
  const real vy = c->vy - vn * c->ny;
  const real vz = c->vz - vn * c->nz;

  const real length2 = s->x * s->x + s->y * s->y + s->z * s->z;
  const real sn = s->x * c->nx + s->y * c->ny + s->z * c->nz;
  const real px = s->x - sn * c->nx;
  const real py = s->y - sn * c->ny;
  const real pz = s->z - sn * c->nz;
  const real plane2 = den * (px * px + py * py + pz * pz);
  const real turn = plane2 > tiny ? calx_sqrt(num * length2 / calx_max(plane2, tiny)) : R(0.0);
  const real ox = turn * px;
  const real oy = turn * py;
  const real oz = turn * pz;

  const real tx = ox + vx * c->dt;
  const real ty = oy + vy * c->dt;
  const real tz = oz + vz * c->dt;
  /* Beyond the limit on its own, the spring is shortened to it and the dashpot is off. Where only spring and dashpot
   * together are beyond, the sum is cut and the spring stays. One root and one division serve both. */
  const real trial2 = kt * kt * (tx * tx + ty * ty + tz * tz);
  const real limit2 = limit * limit;
  const real dash = trial2 > limit2 ? R(0.0) : ct;
  const real hx = kt * tx + dash * vx;
  const real hy = kt * ty + dash * vy;
  const real hz = kt * tz + dash * vz;
  const real sum2 = hx * hx + hy * hy + hz * hz;
  const real cut = sum2 > limit2 ? limit / calx_sqrt(calx_max(sum2, tiny)) : R(1.0);
  const real slip = trial2 > limit2 ? cut : R(1.0);
  s->x = slip * tx;
  s->y = slip * ty;
  s->z = slip * tz;
  s->fx = -cut * hx;
  s->fy = -cut * hy;
  s->fz = -cut * hz;

  const real gx = kt * s->x;
  const real gy = kt * s->y;
  const real gz = kt * s->z;
  /* Work by the trapezoid of old and new force, less what is stored more than before. The force before has the size it
   * had and the direction of the carried spring. */
  const real old2 = ox * ox + oy * oy + oz * oz;
  const real k_old = old2 > tiny ? kt_before * calx_sqrt(length2 / calx_max(old2, tiny)) : R(0.0);
  const real work = R(0.5) * c->dt * ((k_old * ox + gx) * vx + (k_old * oy + gy) * vy + (k_old * oz + gz) * vz);
  s->elastic = R(0.5) * kt * (s->x * s->x + s->y * s->y + s->z * s->z);
  s->friction = work - (s->elastic - R(0.5) * kt_before * length2);
  /* The dashpot works on the mean velocity of the step. The force of this contact changes that by 7/2 F dt / m* (solid
   * spheres: 1/m* + r^2/I), half of it on the mean. */
  const real half_step = R(1.75) * c->dt / c->m_eff;
  s->damping = -c->dt * ((s->fx + gx) * (vx + half_step * s->fx) + (s->fy + gy) * (vy + half_step * s->fy) +
                         (s->fz + gz) * (vz + half_step * s->fz));
}
