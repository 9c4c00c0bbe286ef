/* layout_v1.c: size and place of every member of every struct of ABI 1.0, and the value of every constant, on machines
 * with pointers of 8 bytes. Compiling it is the test. Rows may be added when a struct that grows has grown at its tail;
 * a row that changes breaks every plugin already built. check_abi.py says which member has no row. */
#include <calx/all.h>

/* Tables of functions and what stands in arrays have this size for ever. */
#define SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type " has another size")
/* Structs handed over by pointer with their struct_size grow at the tail; so large they were in 1.0. */
#define GROWS(type, bytes) _Static_assert(sizeof(type) >= (bytes), #type " is smaller than in ABI 1.0")
#define AT(type, member, place, bytes)                                           \
  _Static_assert(offsetof(type, member) == (place), #type "." #member " moved"); \
  _Static_assert(sizeof(((type*)0)->member) == (bytes), #type "." #member " has another size")
#define IS(name, value) _Static_assert((name) == (value), #name " has another value")
#define TEXT(name, text) _Static_assert(__builtin_strcmp(name, text) == 0, #name " has another text")

SIZE(void*, 8);
SIZE(calx_status, 4);

/* calx/abi.h */
GROWS(calx_host, 48);
AT(calx_host, struct_size, 0, 4);
AT(calx_host, abi_major, 4, 2);
AT(calx_host, abi_minor, 6, 2);
AT(calx_host, self, 8, 8);
AT(calx_host, name, 16, 8);
AT(calx_host, version, 24, 8);
AT(calx_host, get_extension, 32, 8);
AT(calx_host, fail, 40, 8);
SIZE(calx_field, 56);
AT(calx_field, name, 0, 8);
AT(calx_field, unit, 8, 8);
AT(calx_field, doc, 16, 8);
AT(calx_field, lowest, 24, 8);
AT(calx_field, highest, 32, 8);
AT(calx_field, preset, 40, 8);
AT(calx_field, flags, 48, 4);
AT(calx_field, reserved, 52, 4);
GROWS(calx_descriptor, 96);
AT(calx_descriptor, struct_size, 0, 4);
AT(calx_descriptor, flags, 4, 4);
AT(calx_descriptor, id, 8, 8);
AT(calx_descriptor, kind, 16, 8);
AT(calx_descriptor, name, 24, 8);
AT(calx_descriptor, version, 32, 8);
AT(calx_descriptor, vendor, 40, 8);
AT(calx_descriptor, license, 48, 8);
AT(calx_descriptor, summary, 56, 8);
AT(calx_descriptor, required, 64, 8);
AT(calx_descriptor, parameter, 72, 8);
AT(calx_descriptor, parameter_count, 80, 4);
AT(calx_descriptor, reserved, 84, 4);
AT(calx_descriptor, extra_schema, 88, 8);
GROWS(calx_config, 32);
AT(calx_config, struct_size, 0, 4);
AT(calx_config, value_count, 4, 4);
AT(calx_config, value, 8, 8);
AT(calx_config, json, 16, 8);
AT(calx_config, json_size, 24, 8);
SIZE(calx_factory, 40);
AT(calx_factory, count, 0, 8);
AT(calx_factory, descriptor, 8, 8);
AT(calx_factory, create, 16, 8);
AT(calx_factory, destroy, 24, 8);
AT(calx_factory, get_interface, 32, 8);
GROWS(calx_entry, 40);
AT(calx_entry, magic, 0, 4);
AT(calx_entry, abi_major, 4, 2);
AT(calx_entry, abi_minor, 6, 2);
AT(calx_entry, struct_size, 8, 4);
AT(calx_entry, flags, 12, 4);
AT(calx_entry, init, 16, 8);
AT(calx_entry, deinit, 24, 8);
AT(calx_entry, get_factory, 32, 8);

/* calx/contact_law.h */
GROWS(calx_block_f32, 464);
AT(calx_block_f32, struct_size, 0, 4);
AT(calx_block_f32, count, 4, 4);
AT(calx_block_f32, stride, 8, 8);
AT(calx_block_f32, dt, 16, 8);
AT(calx_block_f32, time, 24, 8);
AT(calx_block_f32, in, 32, 256);
AT(calx_block_f32, out, 288, 128);
AT(calx_block_f32, pair, 416, 8);
AT(calx_block_f32, prop_i, 424, 8);
AT(calx_block_f32, prop_j, 432, 8);
AT(calx_block_f32, add_i, 440, 8);
AT(calx_block_f32, add_j, 448, 8);
AT(calx_block_f32, state, 456, 8);
GROWS(calx_block_f64, 464);
AT(calx_block_f64, struct_size, 0, 4);
AT(calx_block_f64, count, 4, 4);
AT(calx_block_f64, stride, 8, 8);
AT(calx_block_f64, dt, 16, 8);
AT(calx_block_f64, time, 24, 8);
AT(calx_block_f64, in, 32, 256);
AT(calx_block_f64, out, 288, 128);
AT(calx_block_f64, pair, 416, 8);
AT(calx_block_f64, prop_i, 424, 8);
AT(calx_block_f64, prop_j, 432, 8);
AT(calx_block_f64, add_i, 440, 8);
AT(calx_block_f64, add_j, 448, 8);
AT(calx_block_f64, state, 456, 8);
SIZE(calx_contact_law, 152);
AT(calx_contact_law, struct_size, 0, 4);
AT(calx_contact_law, draft, 4, 4);
AT(calx_contact_law, dialect, 8, 4);
AT(calx_contact_law, flags, 12, 4);
AT(calx_contact_law, needs, 16, 4);
AT(calx_contact_law, material_count, 20, 4);
AT(calx_contact_law, given_count, 24, 4);
AT(calx_contact_law, pair_count, 28, 4);
AT(calx_contact_law, prop_count, 32, 4);
AT(calx_contact_law, state_count, 36, 4);
AT(calx_contact_law, material, 40, 8);
AT(calx_contact_law, given, 48, 8);
AT(calx_contact_law, pair, 56, 8);
AT(calx_contact_law, prop, 64, 8);
AT(calx_contact_law, state, 72, 8);
AT(calx_contact_law, derive, 80, 8);
AT(calx_contact_law, stable_dt, 88, 8);
AT(calx_contact_law, reach, 96, 8);
AT(calx_contact_law, symbol, 104, 8);
AT(calx_contact_law, source, 112, 8);
AT(calx_contact_law, source_size, 120, 8);
AT(calx_contact_law, source_sha256, 128, 8);
AT(calx_contact_law, eval_f32, 136, 8);
AT(calx_contact_law, eval_f64, 144, 8);

/* calx/geometry.h */
SIZE(calx_shape_sink, 32);
AT(calx_shape_sink, struct_size, 0, 4);
AT(calx_shape_sink, reserved, 4, 4);
AT(calx_shape_sink, self, 8, 8);
AT(calx_shape_sink, triangles, 16, 8);
AT(calx_shape_sink, revolution, 24, 8);
SIZE(calx_geometry, 16);
AT(calx_geometry, struct_size, 0, 4);
AT(calx_geometry, draft, 4, 4);
AT(calx_geometry, build, 8, 8);

/* calx/host_log.h */
SIZE(calx_host_log, 16);
AT(calx_host_log, struct_size, 0, 4);
AT(calx_host_log, reserved, 4, 4);
AT(calx_host_log, write, 8, 8);

/* calx/motion.h */
SIZE(calx_pose, 144);
AT(calx_pose, pivot, 0, 24);
AT(calx_pose, displacement, 24, 24);
AT(calx_pose, quaternion, 48, 32);
AT(calx_pose, velocity, 80, 24);
AT(calx_pose, spin, 104, 24);
AT(calx_pose, angle, 128, 8);
AT(calx_pose, cycle, 136, 8);
SIZE(calx_motion, 32);
AT(calx_motion, struct_size, 0, 4);
AT(calx_motion, draft, 4, 4);
AT(calx_motion, pose, 8, 8);
AT(calx_motion, duration, 16, 8);
AT(calx_motion, top_speed, 24, 8);

/* calx/particle_force.h */
GROWS(calx_particle_block, 160);
AT(calx_particle_block, struct_size, 0, 4);
AT(calx_particle_block, count, 4, 4);
AT(calx_particle_block, dt, 8, 8);
AT(calx_particle_block, time, 16, 8);
AT(calx_particle_block, x, 24, 8);
AT(calx_particle_block, y, 32, 8);
AT(calx_particle_block, z, 40, 8);
AT(calx_particle_block, vx, 48, 8);
AT(calx_particle_block, vy, 56, 8);
AT(calx_particle_block, vz, 64, 8);
AT(calx_particle_block, wx, 72, 8);
AT(calx_particle_block, wy, 80, 8);
AT(calx_particle_block, wz, 88, 8);
AT(calx_particle_block, mass, 96, 8);
AT(calx_particle_block, radius, 104, 8);
AT(calx_particle_block, fx, 112, 8);
AT(calx_particle_block, fy, 120, 8);
AT(calx_particle_block, fz, 128, 8);
AT(calx_particle_block, mx, 136, 8);
AT(calx_particle_block, my, 144, 8);
AT(calx_particle_block, mz, 152, 8);
SIZE(calx_particle_force, 72);
AT(calx_particle_force, struct_size, 0, 4);
AT(calx_particle_force, draft, 4, 4);
AT(calx_particle_force, eval, 8, 8);
AT(calx_particle_force, dialect, 16, 4);
AT(calx_particle_force, row_count, 20, 4);
AT(calx_particle_force, row, 24, 8);
AT(calx_particle_force, symbol, 32, 8);
AT(calx_particle_force, source, 40, 8);
AT(calx_particle_force, source_size, 48, 8);
AT(calx_particle_force, source_sha256, 56, 8);
AT(calx_particle_force, numbers, 64, 8);

/* calx/sensor.h */
GROWS(calx_sensor_view, 136);
AT(calx_sensor_view, struct_size, 0, 4);
AT(calx_sensor_view, reserved, 4, 4);
AT(calx_sensor_view, count, 8, 8);
AT(calx_sensor_view, time, 16, 8);
AT(calx_sensor_view, id, 24, 8);
AT(calx_sensor_view, x, 32, 8);
AT(calx_sensor_view, y, 40, 8);
AT(calx_sensor_view, z, 48, 8);
AT(calx_sensor_view, vx, 56, 8);
AT(calx_sensor_view, vy, 64, 8);
AT(calx_sensor_view, vz, 72, 8);
AT(calx_sensor_view, wx, 80, 8);
AT(calx_sensor_view, wy, 88, 8);
AT(calx_sensor_view, wz, 96, 8);
AT(calx_sensor_view, mass, 104, 8);
AT(calx_sensor_view, radius, 112, 8);
AT(calx_sensor_view, input, 120, 8);
AT(calx_sensor_view, input_count, 128, 8);
SIZE(calx_sensor, 32);
AT(calx_sensor, struct_size, 0, 4);
AT(calx_sensor, draft, 4, 4);
AT(calx_sensor, output, 8, 8);
AT(calx_sensor, output_count, 16, 4);
AT(calx_sensor, reserved, 20, 4);
AT(calx_sensor, sample, 24, 8);

/* calx/servo.h */
GROWS(calx_servo_view, 72);
AT(calx_servo_view, struct_size, 0, 4);
AT(calx_servo_view, reserved, 4, 4);
AT(calx_servo_view, time, 8, 8);
AT(calx_servo_view, dt, 16, 8);
AT(calx_servo_view, force, 24, 24);
AT(calx_servo_view, torque, 48, 24);
SIZE(calx_servo, 40);
AT(calx_servo, struct_size, 0, 4);
AT(calx_servo, draft, 4, 4);
AT(calx_servo, pose, 8, 8);
AT(calx_servo, advance, 16, 8);
AT(calx_servo, top_speed, 24, 8);
AT(calx_servo, reach, 32, 8);

/* calx/state.h */
SIZE(calx_stream, 32);
AT(calx_stream, struct_size, 0, 4);
AT(calx_stream, reserved, 4, 4);
AT(calx_stream, self, 8, 8);
AT(calx_stream, write, 16, 8);
AT(calx_stream, read, 24, 8);
SIZE(calx_state, 32);
AT(calx_state, struct_size, 0, 4);
AT(calx_state, draft, 4, 4);
AT(calx_state, schema, 8, 4);
AT(calx_state, reserved, 12, 4);
AT(calx_state, save, 16, 8);
AT(calx_state, load, 24, 8);

/* Constants. */
IS(CALX_ABI_MAGIC, 0x314c4143u);
IS(CALX_ABI_MAJOR, 1);
_Static_assert(CALX_ABI_MINOR >= 0, "the minor version");
IS(CALX_ABI_DRAFT, 0);
IS(CALX_OK, 0);
IS(CALX_E_UNSUPPORTED, -1);
IS(CALX_E_ARGUMENT, -2);
IS(CALX_E_CONFIG, -3);
IS(CALX_E_MEMORY, -4);
IS(CALX_E_IO, -5);
IS(CALX_E_STATE, -6);
IS(CALX_E_VERSION, -7);
IS(CALX_E_INTERNAL, -100);
IS(CALX_FIELD_INTEGER, 1);
IS(CALX_FIELD_ODD, 2);
IS(CALX_FIELD_KEEP_APART, 4);
IS(CALX_FIELD_ACCUMULATE, 8);
IS(CALX_FIELD_CHOICE, 16);
IS(CALX_FIELD_REQUIRED, 32);
TEXT(CALX_FACTORY, "calx.factory/1");
TEXT(CALX_CONTACT_LAW, "calx.contact-law/1");
IS(CALX_LAW_EXACT, 1);
IS(CALX_LAW_ACTIVE, 2);
IS(CALX_IN_OVERLAP, 0);
IS(CALX_IN_NX, 1);
IS(CALX_IN_NY, 2);
IS(CALX_IN_NZ, 3);
IS(CALX_IN_VX, 4);
IS(CALX_IN_VY, 5);
IS(CALX_IN_VZ, 6);
IS(CALX_IN_WX, 7);
IS(CALX_IN_WY, 8);
IS(CALX_IN_WZ, 9);
IS(CALX_IN_R_EFF, 10);
IS(CALX_IN_M_EFF, 11);
IS(CALX_IN_R_I, 12);
IS(CALX_IN_R_J, 13);
IS(CALX_IN_FN_BEFORE, 14);
_Static_assert(CALX_IN_COUNT >= 15, "columns of ABI 1.0 are gone");
IS(CALX_OUT_FX, 0);
IS(CALX_OUT_FY, 1);
IS(CALX_OUT_FZ, 2);
IS(CALX_OUT_MX, 3);
IS(CALX_OUT_MY, 4);
IS(CALX_OUT_MZ, 5);
IS(CALX_OUT_ELASTIC, 6);
IS(CALX_OUT_FRICTION, 7);
IS(CALX_OUT_DAMPING, 8);
IS(CALX_OUT_PLASTIC, 9);
_Static_assert(CALX_OUT_COUNT >= 10, "columns of ABI 1.0 are gone");
TEXT(CALX_GEOMETRY, "calx.geometry/1");
TEXT(CALX_HOST_LOG, "calx.host.log/1");
IS(CALX_LOG_INFO, 0);
IS(CALX_LOG_WARNING, 1);
TEXT(CALX_MOTION, "calx.motion/1");
TEXT(CALX_PARTICLE_FORCE, "calx.particle-force/1");
TEXT(CALX_SENSOR, "calx.sensor/1");
TEXT(CALX_SERVO, "calx.servo/1");
TEXT(CALX_STATE, "calx.state/1");
_Static_assert(CALX_VEC(1) == 1u << 8 && CALX_VEC(255) == 255u << 8, "CALX_VEC has another value");
