/* SPDX-License-Identifier: MIT
 * calx/law/sliding.h: tangential spring, dashpot and Coulomb slider, written in the law dialect and shared by several
 * laws. Include after prelude.h, once per precision; a host puts its text after the prelude's.
 *
 * The spring is a displacement vector in the contact plane (m). Each step it is carried into the new plane: projected,
 * then given its old length back. Its stiffness may change with the overlap. While it grows, the force is kept and the
 * displacement shrinks; while it falls, the displacement is kept and the force falls with it. Both lose energy or keep
 * it, so no cycle of loading and shearing creates energy (the rule of LAMMPS' mindlin/rescale). */
typedef struct CALX_ID(calx_spring) {
  real x, y, z;                    /* m, in and out: the spring, odd under exchange of i and j */
  real fx, fy, fz;                 /* N, out: tangential force on i */
  real elastic, friction, damping; /* J, out: stored now; lost in this step to sliding; lost to the dashpot */
} CALX_ID(calx_spring);

/* vn         m/s, normal component of the velocity
 * kt         N/m, stiffness now; kt_before: one step earlier (read by the energy outputs only)
 * num, den   their ratio is (kt_before / kt)^2 or, where that exceeds 1, 1. Given apart, so that one division serves
 *            this and the turn of the spring; den = 0 empties the spring
 * ct         kg/s, dashpot; it acts only while spring and dashpot together stay below the limit
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
  const real trial2 = kt * kt * (tx * tx + ty * ty + tz * tz);
  const real limit2 = limit * limit;
  const real slip = trial2 > limit2 ? limit / calx_sqrt(calx_max(trial2, tiny)) : R(1.0);
  s->x = slip * tx;
  s->y = slip * ty;
  s->z = slip * tz;

  const real gx = kt * s->x;
  const real gy = kt * s->y;
  const real gz = kt * s->z;
  const real hx = gx + ct * vx;
  const real hy = gy + ct * vy;
  const real hz = gz + ct * vz;
  const real dash = calx_max(trial2, hx * hx + hy * hy + hz * hz) > limit2 ? R(0.0) : ct;
  s->fx = -(gx + dash * vx);
  s->fy = -(gy + dash * vy);
  s->fz = -(gz + dash * vz);

  /* Work by the trapezoid of old and new force, less what is stored more than before. The force before is that of the
   * stiffer of the two springs on the carried displacement. */
  const real k_old = calx_max(kt, kt_before);
  const real work = R(0.5) * c->dt * ((k_old * ox + gx) * vx + (k_old * oy + gy) * vy + (k_old * oz + gz) * vz);
  s->elastic = R(0.5) * kt * (s->x * s->x + s->y * s->y + s->z * s->z);
  s->friction = work - (s->elastic - R(0.5) * kt_before * length2);
  s->damping = dash * c->dt * (vx * vx + vy * vy + vz * vz);
}
