/* SPDX-License-Identifier: MIT
 * calx/servo.h: a motion that reacts to the load on its parts, "calx.servo/1": a lid under constant stress, a drive
 * that stops at a force. C99 and C++98.
 *
 * calx.motion/1 is a pure function of time; a servo has a state and goes from step to step. Every servo also has the
 * table "calx.state/1", so that a resumed run has the bits of one without a pause. It must not read clocks, files or
 * random numbers: the same loads give the same bits. */
#ifndef CALX_SERVO_H
#define CALX_SERVO_H
#include "motion.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_SERVO "calx.servo/1"

/* What a servo may look at when it goes on by one step. */
typedef struct calx_servo_view {
  uint32_t struct_size, reserved;
  double time; /* s since the start event, of the pose to come; above 0 */
  double dt;   /* s, from the pose before to the pose to come; the same in every step of a run */
  /* Of the particles on all parts that the servo moves, those of motions it carries included, at the pose before, in
   * the servo's own frame: the world's, unless another motion carries and turns it. */
  double force[3];  /* N */
  double torque[3]; /* N m, about the pivot where it is */
} calx_servo_view;

typedef struct calx_servo {
  uint32_t struct_size, draft; /* draft: CALX_ABI_DRAFT */
  /* Present pose; that of rest before the first advance. velocity and spin are those that led to it, so that over a
   * step the pose changes by dt times them. [main] */
  calx_status(CALX_CALL* pose)(const calx_instance* self, calx_pose* out);
  /* Goes on by one step. Called once per time step from the start event on; never before it. A negative status with a
   * message through host->fail ends the run. [main] */
  calx_status(CALX_CALL* advance)(calx_instance* self, const calx_host* host, const calx_servo_view* view);
  /* Largest speed of any point within radius r of the pivot, whatever the loads, m/s. [any] */
  double(CALX_CALL* top_speed)(const calx_instance* self, double r);
  /* Largest distance of the pivot from its place at rest, whatever the loads, m, finite. [any] */
  double(CALX_CALL* reach)(const calx_instance* self);
} calx_servo;

#ifdef __cplusplus
}
#endif
#endif
