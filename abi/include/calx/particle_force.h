/* SPDX-License-Identifier: MIT
 * calx/particle_force.h: a force on single particles (drag, vibration pick-up, a field), "calx.particle-force/1".
 * C99 and C++98. */
#ifndef CALX_PARTICLE_FORCE_H
#define CALX_PARTICLE_FORCE_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_PARTICLE_FORCE "calx.particle-force/1"

/* Columns of the centres of mass, world frame, SI; count rows each, none null. The force adds to f and m. */
typedef struct calx_particle_block {
  uint32_t struct_size, count;
  double dt, time;                    /* s */
  const double *x, *y, *z;            /* m */
  const double *vx, *vy, *vz;         /* m/s */
  const double *wx, *wy, *wz;         /* rad/s */
  const double *mass, *radius;        /* kg; m, of the sphere of equal volume */
  double *fx, *fy, *fz, *mx, *my, *mz; /* N, N m; added to */
} calx_particle_block;

typedef struct calx_particle_force {
  uint32_t struct_size, draft; /* draft: CALX_ABI_DRAFT */
  /* Pure in the block and the instance; rows are independent of each other and of the block's size. [worker] */
  void(CALX_CALL* eval)(const calx_instance* self, const calx_particle_block* block);
  /* The force as a text of dialect 1 (see law/prelude.h, CALX_FORCE_EVAL), which devices run; source null: native code
   * only, and a case with this force stays on the processor. eval must give the bits of the text. */
  uint32_t dialect, row_count;
  const calx_field* row; /* numbers of the instance that the text reads */
  const char* symbol;    /* "drag": prefix of every name in the text */
  const char* source;    /* source_size bytes */
  uint64_t source_size;
  const char* source_sha256; /* hex */
  /* Fills row_count numbers. Set-up only. [main] */
  void(CALX_CALL* numbers)(const calx_instance* self, double* row);
} calx_particle_force;

#ifdef __cplusplus
}
#endif
#endif
