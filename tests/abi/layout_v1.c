/* layout_v1.c: size and place of everything in the tables of ABI 1, on LP64. Compiling it is the test. Rows may be
 * added when a struct grows at its tail; a row that changes breaks every plugin already built. */
#include <calx/all.h>
#include <calx/contact_law.h>
#include <calx/sensor.h>

#define SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type " has another size")
#define AT(type, member, bytes) _Static_assert(offsetof(type, member) == (bytes), #type "." #member " moved")

SIZE(void*, 8);
SIZE(calx_status, 4);

SIZE(calx_host, 48);
AT(calx_host, abi_major, 4);
AT(calx_host, self, 8);
AT(calx_host, get_extension, 32);
AT(calx_host, fail, 40);

SIZE(calx_field, 56);
AT(calx_field, name, 0);
AT(calx_field, unit, 8);
AT(calx_field, doc, 16);
AT(calx_field, lowest, 24);
AT(calx_field, preset, 40);
AT(calx_field, flags, 48);

SIZE(calx_descriptor, 96);
AT(calx_descriptor, id, 8);
AT(calx_descriptor, kind, 16);
AT(calx_descriptor, required, 64);
AT(calx_descriptor, parameter, 72);
AT(calx_descriptor, parameter_count, 80);
AT(calx_descriptor, extra_schema, 88);

SIZE(calx_config, 32);
AT(calx_config, value, 8);
AT(calx_config, json, 16);
AT(calx_config, json_size, 24);

SIZE(calx_factory, 40);
AT(calx_factory, create, 16);
AT(calx_factory, get_interface, 32);

SIZE(calx_entry, 40);
AT(calx_entry, magic, 0);
AT(calx_entry, abi_major, 4);
AT(calx_entry, struct_size, 8);
AT(calx_entry, init, 16);
AT(calx_entry, get_factory, 32);

SIZE(calx_block_f32, 464);
SIZE(calx_block_f64, 464);
AT(calx_block_f64, stride, 8);
AT(calx_block_f64, dt, 16);
AT(calx_block_f64, in, 32);
AT(calx_block_f64, out, 288);
AT(calx_block_f64, pair, 416);
AT(calx_block_f64, prop_i, 424);
AT(calx_block_f64, add_i, 440);
AT(calx_block_f64, state, 456);
AT(calx_block_f32, state, 456);

SIZE(calx_contact_law, 152);
AT(calx_contact_law, needs, 16);
AT(calx_contact_law, state_count, 36);
AT(calx_contact_law, material, 40);
AT(calx_contact_law, state, 72);
AT(calx_contact_law, derive, 80);
AT(calx_contact_law, stable_dt, 88);
AT(calx_contact_law, reach, 96);
AT(calx_contact_law, symbol, 104);
AT(calx_contact_law, source_sha256, 128);
AT(calx_contact_law, eval_f32, 136);
AT(calx_contact_law, eval_f64, 144);

SIZE(calx_servo_view, 72);
AT(calx_servo_view, time, 8);
AT(calx_servo_view, dt, 16);
AT(calx_servo_view, force, 24);
AT(calx_servo_view, torque, 48);

SIZE(calx_servo, 40);
AT(calx_servo, draft, 4);
AT(calx_servo, pose, 8);
AT(calx_servo, advance, 16);
AT(calx_servo, top_speed, 24);
AT(calx_servo, reach, 32);
SIZE(calx_sensor_view, 136);
AT(calx_sensor_view, count, 8);
AT(calx_sensor_view, time, 16);
AT(calx_sensor_view, id, 24);
AT(calx_sensor_view, x, 32);
AT(calx_sensor_view, radius, 112);
AT(calx_sensor_view, input, 120);
AT(calx_sensor_view, input_count, 128);
