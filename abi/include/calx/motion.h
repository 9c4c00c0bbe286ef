/* SPDX-License-Identifier: MIT
 * calx/motion.h: how a part moves, "calx.motion/1". C99 and C++98.
 *
 * Motion is an axis with an angle, and a displacement, as functions of time since the motion's start event; never an
 * end pose, because at exactly 180 degrees the way between two poses is undefined. */
#ifndef CALX_MOTION_H
#define CALX_MOTION_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_MOTION "calx.motion/1"

/* A point at X before the motion is at pivot + displacement + q (X - pivot) q*, world frame. */
typedef struct calx_pose {
  double pivot[3];        /* m */
  double displacement[3]; /* m */
  double quaternion[4];   /* w, x, y, z; unit length, keeps its sign along the motion */
  double velocity[3];     /* m/s, of the point that stood at pivot */
  double spin[3];         /* rad/s */
  double angle;           /* rad, unwrapped; 0 for pure translation */
  double cycle;           /* completed cycles, its fraction the progress within the present one; 0 if it has none */
} calx_pose;

typedef struct calx_motion {
  uint32_t struct_size, draft; /* draft: CALX_ABI_DRAFT */
  /* Pose at time t, s, since the start event; t <= 0 gives the pose at rest. Pure: the same t gives the same bits.
   * Velocities are the exact derivative of the pose. CALX_E_ARGUMENT for a non-finite t. [worker] */
  calx_status(CALX_CALL* pose)(const calx_instance* self, double t, calx_pose* out);
  /* Time after which the pose no longer changes, s; infinite for an endless motion. [any] */
  double(CALX_CALL* duration)(const calx_instance* self);
  /* Largest speed of any point within radius r of the pivot over the whole motion, m/s. [any] */
  double(CALX_CALL* top_speed)(const calx_instance* self, double r);
} calx_motion;

#ifdef __cplusplus
}
#endif
#endif
