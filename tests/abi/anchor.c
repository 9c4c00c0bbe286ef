/* anchor.c: a library that exports one constant of each struct of the boundary, so that abidw sees all of their types;
 * real plugins hand their tables over as const void*, behind which it sees nothing. abi_1_0.xml is what abidw wrote of
 * it when ABI 1.0 was released; check_abi.py compares. */
#include <calx/all.h>

#define ANCHOR(type)                           \
  CALX_EXPORT extern const type anchor_##type; \
  const type anchor_##type = {0}

ANCHOR(calx_host);
ANCHOR(calx_field);
ANCHOR(calx_descriptor);
ANCHOR(calx_config);
ANCHOR(calx_factory);
ANCHOR(calx_entry);
ANCHOR(calx_block_f32);
ANCHOR(calx_block_f64);
ANCHOR(calx_contact_law);
ANCHOR(calx_shape_sink);
ANCHOR(calx_geometry);
ANCHOR(calx_host_log);
ANCHOR(calx_pose);
ANCHOR(calx_motion);
ANCHOR(calx_particle_block);
ANCHOR(calx_particle_force);
ANCHOR(calx_sensor_view);
ANCHOR(calx_sensor);
ANCHOR(calx_servo_view);
ANCHOR(calx_servo);
ANCHOR(calx_stream);
ANCHOR(calx_state);
ANCHOR(calx_eval_f32);
ANCHOR(calx_eval_f64);
