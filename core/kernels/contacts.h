/* contacts.h: contacts between spheres, one item for each entry of the pair list. calx_contact_laws is generated from
 * the laws of the case. */
#ifndef CALX_CONTACTS_H
#define CALX_CONTACTS_H

/* Values of an entry that touches, in columns `entries` apart: force on i, torque on i, torque that j loses. */
#define PAIR_VALUES 9u

KERNEL(pair_contacts, step_numbers n, GLOBAL const record* RESTRICT spheres, GLOBAL const u32* RESTRICT material,
       GLOBAL const u32* RESTRICT first, GLOBAL const u32* RESTRICT second, GLOBAL u8* RESTRICT touching,
       GLOBAL double* RESTRICT history, GLOBAL const u32* RESTRICT law_of, GLOBAL const double* RESTRICT law_numbers,
       GLOBAL double* RESTRICT out, GLOBAL double* RESTRICT share, GLOBAL double* RESTRICT energy,
       GLOBAL u32* RESTRICT flags) {
  const u32 e = ITEM;
  if (e >= n.entries) return;
  const u32 i = first[e], j = second[e];
  GLOBAL const record* a = spheres + i;
  GLOBAL const record* b = spheres + j;
  double x = a->x - b->x, y = a->y - b->y, z = a->z - b->z;
  if (n.periodic_x) x = nearest_image(x, n.length_x);
  if (n.periodic_y) y = nearest_image(y, n.length_y);
  if (n.periodic_z) z = nearest_image(z, n.length_z);
  const double reach = a->r + b->r, d2 = x * x + y * y + z * z;
  share[e] = 0.0;
  if (!(d2 < reach * reach)) {
    touching[e] = 0;
    return;
  }
  const u32 starts = touching[e] == 0;
  touching[e] = 1;
  const double distance = sqrt_f64(d2), inverse = 1.0 / distance;
  const vec3 normal = make3_f64(x * inverse, y * inverse, z * inverse);
  calx_contact_f64 c;
  c.overlap = a->r + b->r - distance;
  c.nx = normal.x;
  c.ny = normal.y;
  c.nz = normal.z;
  c.r_eff = a->r * b->r / (a->r + b->r);
  c.m_eff = a->m * b->m / (a->m + b->m);
  c.r_i = a->r;
  c.r_j = b->r;
  c.dt = n.dt;
  const double arm_i = a->r - 0.5 * c.overlap, arm_j = b->r - 0.5 * c.overlap;
  c.wx = a->wx - b->wx;
  c.wy = a->wy - b->wy;
  c.wz = a->wz - b->wz;
  const double sx = arm_i * a->wx + arm_j * b->wx, sy = arm_i * a->wy + arm_j * b->wy,
               sz = arm_i * a->wz + arm_j * b->wz;
  c.vx = a->vx - b->vx - (sy * normal.z - sz * normal.y);
  c.vy = a->vy - b->vy - (sz * normal.x - sx * normal.z);
  c.vz = a->vz - b->vz - (sx * normal.y - sy * normal.x);
  share[e] = 0.5 * c.overlap / c.r_eff;

  const u32 pair = material[i] * n.materials + material[j];
  calx_wrench_f64 w;
  if (!calx_contact_laws(law_of[pair], &c, history + (u64)e * n.columns, (u64)1, starts, law_numbers, &w)) {
    ATOMIC_MAX(flags + FLAG_MISSING_LAW, pair + 1u);
    touching[e] = 0;
    return;
  }
  const vec3 turning = cross3_f64(normal, make3_f64(w.fx, w.fy, w.fz));
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

#endif
