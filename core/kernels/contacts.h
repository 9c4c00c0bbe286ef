/* contacts.h: contacts between spheres, one item for each entry of the pair list. Stands in a module once for each
 * precision of the laws, after their text: geometry is that of doubles, the law and what follows are of `real`.
 * calx_contact_laws is generated from the laws of the case. CALX_REACHES: some law acts between surfaces that do not
 * touch; gaps: up to which it does, m, of each ordered material pair, between spheres and then against parts. */

/* Values of an entry that touches or is within that gap, in columns `entries` apart: force on i, torque on i, torque
 * that j loses; times: of the steps to come, s. */
KERNEL(CALX_ID(pair_contacts), step_numbers n, GLOBAL const record* RESTRICT spheres,
       GLOBAL const u32* RESTRICT material, GLOBAL const u32* RESTRICT first, GLOBAL const u32* RESTRICT second,
       GLOBAL u8* RESTRICT touching, GLOBAL double* RESTRICT history, GLOBAL const u32* RESTRICT law_of,
       GLOBAL const double* RESTRICT law_numbers, GLOBAL const double* RESTRICT gaps,
       GLOBAL const double* RESTRICT times, GLOBAL real* RESTRICT out, GLOBAL double* RESTRICT share,
       GLOBAL double* RESTRICT energy, GLOBAL u32* RESTRICT flags) {
  const u32 e = ITEM;
  if (e >= n.entries || flags[FLAG_STOP]) return;
  const u32 i = first[e], j = second[e];
  GLOBAL const record* a = spheres + i;
  GLOBAL const record* b = spheres + j;
  double x = a->x - b->x, y = a->y - b->y, z = a->z - b->z;
  if (n.periodic_x) x = nearest_image(x, n.length_x);
  if (n.periodic_y) y = nearest_image(y, n.length_y);
  if (n.periodic_z) z = nearest_image(z, n.length_z);
  const double reach = a->r + b->r, d2 = x * x + y * y + z * z;
#ifdef CALX_REACHES
  const double limit = reach + gaps[material[i] * n.materials + material[j]];
#else
  const double limit = reach;
#endif
  share[e] = 0.0;
  if (!(d2 < limit * limit)) {
    touching[e] = 0;
    return;
  }
  const u32 starts = touching[e] == 0;
  touching[e] = 1;
  /* Columns that the laws of this pair do not have hold 0, as on the host. */
  for (u32 k = 0; starts && k < n.columns; ++k) history[(u64)e * n.columns + k] = 0.0;
  const double distance = sqrt_f64(d2), inverse = 1.0 / distance, overlap = reach - distance;
  CALX_ID(calx_contact) c;
  c.overlap = (real)overlap;
  c.nx = (real)(x * inverse);
  c.ny = (real)(y * inverse);
  c.nz = (real)(z * inverse);
  c.r_eff = (real)(a->r * b->r / reach);
  const real mass_i = (real)a->m, mass_j = (real)b->m;
  c.m_eff = mass_i * mass_j / (mass_i + mass_j);
  c.r_i = (real)a->r;
  c.r_j = (real)b->r;
  c.dt = (real)n.dt;
  c.time = (real)times[flags[FLAG_DONE]];
  const real arm_i = (real)(a->r - 0.5 * overlap), arm_j = (real)(b->r - 0.5 * overlap);
  const real wix = (real)a->wx, wiy = (real)a->wy, wiz = (real)a->wz;
  const real wjx = (real)b->wx, wjy = (real)b->wy, wjz = (real)b->wz;
  c.wx = wix - wjx;
  c.wy = wiy - wjy;
  c.wz = wiz - wjz;
  const real sx = arm_i * wix + arm_j * wjx, sy = arm_i * wiy + arm_j * wjy, sz = arm_i * wiz + arm_j * wjz;
  c.vx = (real)a->vx - (real)b->vx - (sy * c.nz - sz * c.ny);
  c.vy = (real)a->vy - (real)b->vy - (sz * c.nx - sx * c.nz);
  c.vz = (real)a->vz - (real)b->vz - (sx * c.ny - sy * c.nx);
  share[e] = 0.5 * (double)c.overlap / (double)c.r_eff;

  const u32 pair = material[i] * n.materials + material[j];
  CALX_ID(calx_wrench) w;
  if (!CALX_ID(calx_contact_laws)(law_of[pair], &c, history + (u64)e * n.columns, (u64)1, starts, law_numbers, &w)) {
    ATOMIC_MAX(flags + FLAG_MISSING_LAW, pair + 1u);
    touching[e] = 0;
    return;
  }
  const CALX_ID(vec3) turning = CALX_ID(cross3)(CALX_ID(make3)(c.nx, c.ny, c.nz), CALX_ID(make3)(w.fx, w.fy, w.fz));
  const u64 stride = n.entries;
  out[e] = w.fx;
  out[stride + e] = w.fy;
  out[2 * stride + e] = w.fz;
  out[3 * stride + e] = w.mx - arm_i * turning.x;
  out[4 * stride + e] = w.my - arm_i * turning.y;
  out[5 * stride + e] = w.mz - arm_i * turning.z;
  out[6 * stride + e] = w.mx + arm_j * turning.x;
  out[7 * stride + e] = w.my + arm_j * turning.y;
  out[8 * stride + e] = w.mz + arm_j * turning.z;
  if (n.ledger) {
    energy[e] = w.elastic;
    energy[stride + e] = w.friction;
    energy[2 * stride + e] = w.damping;
    energy[3 * stride + e] = w.plastic;
  }
}
