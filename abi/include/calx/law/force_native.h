/* SPDX-License-Identifier: MIT
 * calx/law/force_native.h: CALX_FORCE_BATCH(SYMBOL) turns the text of a particle force into SYMBOL_batch(row, block), a
 * loop over the columns of a calx_particle_block, and SYMBOL_row_fields, its table of numbers. Include after the text,
 * compiled with CALX_BITS 64. */
#include <calx/particle_force.h>

#define CALX_F_TAKE(name, unit, lo, hi, preset, flags, doc) p.name = row[k++];
#define CALX_F_ROW(name, unit, lo, hi, preset, flags, doc) {#name, unit, doc, lo, hi, preset, flags, 0},
#define CALX_FORCE_BATCH(force)                                                                        \
  static const calx_field force##_row_fields[] = {force##_row_LIST(CALX_F_ROW){0, 0, 0, 0.0, 0.0, 0.0, 0, 0}}; \
  static void force##_batch(const double* row, const calx_particle_block* block) {                     \
    uint32_t k = 0, i;                                                                                 \
    CALX_ID(force##_row) p;                                                                            \
    force##_row_LIST(CALX_F_TAKE)(void) k;                                                             \
    for (i = 0; i < block->count; ++i) {                                                               \
      CALX_ID(calx_body) b;                                                                            \
      CALX_ID(calx_wrench) o;                                                                          \
      b.x = block->x[i];                                                                               \
      b.y = block->y[i];                                                                               \
      b.z = block->z[i];                                                                               \
      b.vx = block->vx[i];                                                                             \
      b.vy = block->vy[i];                                                                             \
      b.vz = block->vz[i];                                                                             \
      b.wx = block->wx[i];                                                                             \
      b.wy = block->wy[i];                                                                             \
      b.wz = block->wz[i];                                                                             \
      b.mass = block->mass[i];                                                                         \
      b.radius = block->radius[i];                                                                     \
      b.dt = block->dt;                                                                                \
      b.time = block->time;                                                                            \
      o.fx = o.fy = o.fz = o.mx = o.my = o.mz = 0.0;                                                   \
      CALX_ID(force##_eval)(&b, &p, &o);                                                               \
      block->fx[i] += o.fx;                                                                            \
      block->fy[i] += o.fy;                                                                            \
      block->fz[i] += o.fz;                                                                            \
      block->mx[i] += o.mx;                                                                            \
      block->my[i] += o.my;                                                                            \
      block->mz[i] += o.mz;                                                                            \
    }                                                                                                  \
  }
