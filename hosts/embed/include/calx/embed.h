/* SPDX-License-Identifier: MIT
 * calx/embed.h: simulations inside another program, as a C library (libcalx). C99 and C++98.
 *
 * A program may hold any number of simulations, each used by one thread at a time, different ones by different threads
 * at once. The library prints nothing, touches no signal and never ends the process. SI units, world frame. The same
 * case, seed and binary give the same bits as `calx run`, for any number of threads.
 *
 * Functions return CALX_SIM_OK or a positive code, the exit code of the command line for the same fault;
 * calx_sim_error() says what failed. Outputs are untouched then. */
#ifndef CALX_EMBED_H
#define CALX_EMBED_H
#include <calx/abi.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_SIM_OK 0
#define CALX_SIM_INTERNAL 1  /* a fault of Calx itself */
#define CALX_SIM_USAGE 2     /* null or unknown name, number out of range, call out of order */
#define CALX_SIM_CASE 3      /* the case is wrong; the message names the JSON pointer */
#define CALX_SIM_PLUGIN 4    /* a plugin is missing or refused, or failed */
#define CALX_SIM_NUMERICS 5  /* blow-up, lost particle, number that is not finite, out of memory */
#define CALX_SIM_FILES 6     /* a file or folder cannot be read or written */
#define CALX_SIM_STOPPED 130 /* a callback asked to stop */

typedef struct calx_sim calx_sim; /* one simulation */

/* All-zero means: all cores, this processor, double precision, plugins as calx finds them. Grows at the tail. */
typedef struct calx_sim_options {
  uint32_t struct_size;    /* sizeof(calx_sim_options) */
  int32_t threads;         /* 0: all cores */
  const char* device;      /* "cpu", "auto", "opencl", "cuda", also with ":number"; null: "cpu" */
  const char* precision;   /* "double" or "mixed"; null: "double" */
  const char* plugin_path; /* folders searched first, separated by ':'; null: none */
  const char* folder;      /* of a case given as text: where its relative paths start; null: the working folder */
  const calx_entry* const* plugins; /* plugins that live in this program, null-terminated; null: none. They are used
                                     * before any of the same id in a folder, and must outlive every simulation */
  const char* const* set;           /* overrides "/json/pointer=value", null-terminated; null: none */
} calx_sim_options;

/* What failed in the last call of this thread that did not return CALX_SIM_OK; "" if none has. Valid until the next
 * call on this thread. [any] */
CALX_EXPORT const char* CALX_CALL calx_sim_error(void);
/* "0.1.0". [any] */
CALX_EXPORT const char* CALX_CALL calx_sim_version(void);

/* A simulation of a case given as JSON text, or of a case file. options may be null. [any] */
CALX_EXPORT int32_t CALX_CALL calx_sim_create(const char* case_json, const calx_sim_options* options, calx_sim** out);
CALX_EXPORT int32_t CALX_CALL calx_sim_open(const char* case_path, const calx_sim_options* options, calx_sim** out);
/* Null is allowed. [any, not during another call on sim] */
CALX_EXPORT void CALX_CALL calx_sim_destroy(calx_sim* sim);

/* --- Time ------------------------------------------------------------------------------------------------------- */

/* Steps, at most; fewer if the case ends (its end time or event). */
CALX_EXPORT int32_t CALX_CALL calx_sim_step(calx_sim* sim, uint64_t steps);
/* To the step that ends nearest to time, s, or to the end of the case. */
CALX_EXPORT int32_t CALX_CALL calx_sim_run_until(calx_sim* sim, double time);
/* Until the named event of the case has fired, the time latest, s, or the end of the case. fired: 1 if it has. */
CALX_EXPORT int32_t CALX_CALL calx_sim_run_until_event(calx_sim* sim, const char* event, double latest, int32_t* fired);
/* All null-safe: 0 for a null sim. */
CALX_EXPORT double CALX_CALL calx_sim_time(const calx_sim* sim);      /* s */
CALX_EXPORT double CALX_CALL calx_sim_time_step(const calx_sim* sim); /* s */
CALX_EXPORT uint64_t CALX_CALL calx_sim_steps(const calx_sim* sim);   /* done so far */
CALX_EXPORT int32_t CALX_CALL calx_sim_finished(const calx_sim* sim); /* 1: end time or end event reached */

/* Called after every `every` steps while stepping; returns 0 to go on, else stepping ends with CALX_SIM_STOPPED. It may
 * read and write the simulation, but not step or destroy it. Null function: none. */
typedef int32_t(CALX_CALL* calx_sim_callback)(calx_sim* sim, void* user);
CALX_EXPORT int32_t CALX_CALL calx_sim_on_step(calx_sim* sim, uint64_t every, calx_sim_callback call, void* user);
/* Called with each message a run would log ("t = 0.1000 s: event \"poured\""). Null function: messages are dropped. */
typedef void(CALX_CALL* calx_sim_listener)(const char* message, void* user);
CALX_EXPORT int32_t CALX_CALL calx_sim_on_message(calx_sim* sim, calx_sim_listener call, void* user);

/* --- Particles ------------------------------------------------------------------------------------------------- */

/* A column of the engine's own memory: row k at data + k * stride bytes, components doubles (or one uint32_t). Rows
 * stand in rank order, which a step may change; "id" tells who is who. Valid until the simulation is stepped, loaded
 * or destroyed. */
typedef struct calx_sim_column {
  void* data;
  uint64_t rows;
  uint32_t stride;     /* bytes */
  uint32_t components; /* 3 for vectors, 4 for orientation */
  const char* unit;    /* "m/s" */
  int32_t is_integer;  /* 1: uint32_t, else double */
  int32_t writable;
} calx_sim_column;
/* name: "position", "velocity", "spin" (rad/s), "orientation" (quaternion w x y z, principal frame to world), "mass",
 * "scale" (of the shape as drawn), "id", "material" and "shape" (numbers in the order of the case). Position, velocity,
 * spin and orientation may be written (orientation stays a unit quaternion); then call calx_sim_particles_written
 * before the next step. */
CALX_EXPORT int32_t CALX_CALL calx_sim_particles(calx_sim* sim, const char* name, calx_sim_column* out);
CALX_EXPORT uint64_t CALX_CALL calx_sim_particle_count(const calx_sim* sim);
/* Says that particle columns were written. Refused with "rest" in the case. A number that is not finite is refused. */
CALX_EXPORT int32_t CALX_CALL calx_sim_particles_written(calx_sim* sim);

/* --- Parts ----------------------------------------------------------------------------------------------------- */

/* A rigid part: a point X of the case is now at position + q X q*, and moves with velocity + spin x (x - centre). */
typedef struct calx_sim_pose {
  double position[3];    /* m */
  double orientation[4]; /* w, x, y, z */
  double centre[3];      /* m, reference of velocity and of torques */
  double velocity[3];    /* m/s, of the centre */
  double spin[3];        /* rad/s */
} calx_sim_pose;
/* The part's number, from 0, in the order of the case. */
CALX_EXPORT int32_t CALX_CALL calx_sim_part(const calx_sim* sim, const char* name, uint32_t* part);
/* Where it stands at the time of the particles; a servo and a part that is driven where they were moved to last. */
CALX_EXPORT int32_t CALX_CALL calx_sim_part_pose(const calx_sim* sim, uint32_t part, calx_sim_pose* out);
/* Force, N, and torque about the part's centre, N m, that the particles exerted on it in the last step. */
CALX_EXPORT int32_t CALX_CALL calx_sim_part_load(const calx_sim* sim, uint32_t part, double force[3], double torque[3]);
/* The caller moves the part from now on: this is its pose at the contacts of the next steps, until it is set anew. Set
 * it once a step; velocities are used by friction and damping and must be those of the movement. Checkpoints do not
 * hold it. */
CALX_EXPORT int32_t CALX_CALL calx_sim_drive_part(calx_sim* sim, uint32_t part, const calx_sim_pose* pose);

/* --- Sensors --------------------------------------------------------------------------------------------------- */

CALX_EXPORT uint32_t CALX_CALL calx_sim_sensor_count(const calx_sim* sim);
/* The sensor's number by its name. */
CALX_EXPORT int32_t CALX_CALL calx_sim_sensor(const calx_sim* sim, const char* name, uint32_t* sensor);
/* Columns of its row, and the name of one with its unit ("mass_kg"); null out of range. Valid while sim lives. */
CALX_EXPORT uint32_t CALX_CALL calx_sim_sensor_columns(const calx_sim* sim, uint32_t sensor);
CALX_EXPORT const char* CALX_CALL calx_sim_sensor_column(const calx_sim* sim, uint32_t sensor, uint32_t column);
/* Samples it now. values: room for `room` numbers, at least its columns. A sensor that measures changes (flow, mass per
 * cycle) counts from its last sample. */
CALX_EXPORT int32_t CALX_CALL calx_sim_sample(calx_sim* sim, uint32_t sensor, double* values, uint32_t room);

/* --- State ----------------------------------------------------------------------------------------------------- */

/* checkpoint.h5 in a folder that exists, as `calx run` writes it, and back: the bits of going on are the same. */
CALX_EXPORT int32_t CALX_CALL calx_sim_save(const calx_sim* sim, const char* folder);
CALX_EXPORT int32_t CALX_CALL calx_sim_load(calx_sim* sim, const char* folder);
/* Hash of all particles and contact history: equal bits, equal text. Writes 64 hex digits and a 0. */
CALX_EXPORT int32_t CALX_CALL calx_sim_digest(const calx_sim* sim, char text[65]);

#ifdef __cplusplus
}
#endif
#endif
