/* forces.h: forces on single particles, one item for each; times: of the steps to come, s. calx_particle_forces is
 * generated from the forces of the case. */
#ifndef CALX_FORCES_H
#define CALX_FORCES_H

KERNEL(particle_forces, step_numbers n, GLOBAL const record* RESTRICT body, GLOBAL const double* RESTRICT radius,
       GLOBAL const double* RESTRICT numbers, GLOBAL const double* RESTRICT times, GLOBAL wrench* RESTRICT added,
       GLOBAL const u32* RESTRICT flags) {
  const u32 p = ITEM;
  if (p >= n.particles || flags[FLAG_STOP]) return;
  GLOBAL const record* a = body + p;
  calx_body_f64 b;
  b.x = a->x;
  b.y = a->y;
  b.z = a->z;
  b.vx = a->vx;
  b.vy = a->vy;
  b.vz = a->vz;
  b.wx = a->wx;
  b.wy = a->wy;
  b.wz = a->wz;
  b.mass = a->m;
  b.radius = radius[p];
  b.dt = n.dt;
  b.time = times[flags[FLAG_DONE]];
  calx_wrench_f64 w;
  w.fx = w.fy = w.fz = w.mx = w.my = w.mz = 0.0;
  calx_particle_forces(&b, numbers, &w);
  wrench out;
  out.fx = w.fx;
  out.fy = w.fy;
  out.fz = w.fz;
  out.tx = w.mx;
  out.ty = w.my;
  out.tz = w.mz;
  added[p] = out;
}

#endif
