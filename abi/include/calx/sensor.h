/* SPDX-License-Identifier: MIT
 * calx/sensor.h: a read-only observer, "calx.sensor/1". C99 and C++98. */
#ifndef CALX_SENSOR_H
#define CALX_SENSOR_H
#include "abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_SENSOR "calx.sensor/1"

/* What a sensor sees: one row per particle in the order of rising id; world frame, SI. */
typedef struct calx_sensor_view {
  uint32_t struct_size, reserved;
  uint64_t count;
  double time;                /* s */
  const uint32_t* id;         /* kept for life */
  const double *x, *y, *z;    /* m */
  const double *vx, *vy, *vz; /* m/s */
  const double *wx, *wy, *wz; /* rad/s */
  const double *mass, *radius; /* kg; m, of the sphere of equal volume */
  /* For an instrument, a sensor that reads another sensor: what that one would have recorded now, SI; count is 0 then and
   * the columns above are null. It gives one number, the figure that is recorded instead. Times rise from call to call;
   * what it keeps between calls belongs to "calx.state/1". input_count is 0 for any other sensor. */
  const double* input;
  uint64_t input_count;
} calx_sensor_view;

typedef struct calx_sensor {
  uint32_t struct_size, draft; /* draft: CALX_ABI_DRAFT */
  const calx_field* output;    /* names and units become the CSV header */
  uint32_t output_count, reserved;
  /* Writes output_count numbers. [main] */
  calx_status(CALX_CALL* sample)(calx_instance* self, const calx_host* host, const calx_sensor_view* view, double* out);
} calx_sensor;

#ifdef __cplusplus
}
#endif
#endif
