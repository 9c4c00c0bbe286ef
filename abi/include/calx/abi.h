/* SPDX-License-Identifier: MIT
 * calx/abi.h: what every Calx plugin and every host agree on. C99 and C++98; needs nothing but stdint and stddef.
 *
 * A plugin exports one constant, calx_plugin_entry. The host finds a factory through it, reads descriptors, creates
 * instances from a configuration, and asks each instance for the function table of its kind.
 * Rules that hold everywhere: SI units, UTF-8 text with ASCII ids, no exception and no output across the boundary,
 * who allocates frees, structs passed by pointer begin with struct_size and may only grow at the tail.
 * Thread tags on functions: [main] the thread that built the simulation; [worker] any one thread, possibly several
 * at once on different data; [any] any thread at any time. */
#ifndef CALX_ABI_H
#define CALX_ABI_H
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define CALX_CALL __cdecl
#define CALX_EXPORT __declspec(dllexport)
#else
#define CALX_CALL
#define CALX_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define CALX_ABI_MAGIC 0x314C4143u /* 'CAL1' on a little-endian machine, so it also tells byte order */
#define CALX_ABI_MAJOR 1
#define CALX_ABI_MINOR 0
/* The `draft` of every table of this header set: they are released, and do not change before ABI 2 (see POLICY.md). A
 * table that is still being tried out has a header of its own and a number above 0, on which both sides must agree. */
#define CALX_ABI_DRAFT 0

typedef int32_t calx_status; /* positive values are reserved */
#define CALX_OK 0
#define CALX_E_UNSUPPORTED (-1) /* asked for something this plugin does not do */
#define CALX_E_ARGUMENT (-2)    /* the caller broke the contract */
#define CALX_E_CONFIG (-3)      /* the user's case is wrong; the message names the key */
#define CALX_E_MEMORY (-4)
#define CALX_E_IO (-5)
#define CALX_E_STATE (-6) /* saved state unreadable or of another schema */
#define CALX_E_VERSION (-7)
#define CALX_E_INTERNAL (-100) /* a bug in the callee */

typedef struct calx_host calx_host;
typedef struct calx_instance calx_instance; /* opaque, owned by the plugin */

struct calx_host {
  uint32_t struct_size;
  uint16_t abi_major, abi_minor;
  void* self;
  const char *name, *version; /* "calx", "0.1.0" */
  /* Null where the host lacks the extension. [any] */
  const void*(CALX_CALL* get_extension)(const calx_host* host, const char* id);
  /* Copies message for the user, returns code: `return host->fail(host, CALX_E_CONFIG, "why");` [any] */
  calx_status(CALX_CALL* fail)(const calx_host* host, calx_status code, const char* message);
};

/* One row of a table of parameters, columns or history. It stands in arrays, so it is final and never grows. */
typedef struct calx_field {
  const char* name; /* [a-z][a-z0-9_]*, unique in its table; a JSON key and an HDF5 name, kept for ever */
  const char* unit; /* products and real powers of SI units: "N/m^1.5"; "1" for none; see CALX_FIELD_CHOICE */
  const char* doc;  /* one sentence */
  double lowest, highest, preset; /* SI, lowest <= preset <= highest */
  uint32_t flags;                 /* CALX_FIELD_*; bits 8..15: vector group, see CALX_VEC */
  uint32_t reserved;
} calx_field;
#define CALX_FIELD_INTEGER (1u << 0)
#define CALX_FIELD_ODD (1u << 1)        /* changes sign when i and j trade places */
#define CALX_FIELD_KEEP_APART (1u << 2) /* history survives separation up to the reach of the law; see contact_law.h */
#define CALX_FIELD_ACCUMULATE (1u << 3) /* particle column a law adds to and never writes */
#define CALX_FIELD_CHOICE (1u << 4)     /* unit holds names separated by '|'; the value is the index of one, from 0 */
#define CALX_FIELD_REQUIRED (1u << 5)   /* the user must give it; the preset only keeps tables and tools working */
/* Three consecutive rows x, y, z of one vector. Names of parameters end in _x _y _z; a case has an array of three. */
#define CALX_VEC(group) ((uint32_t)(group) << 8)

typedef struct calx_descriptor {
  uint32_t struct_size, flags;
  const char* id;   /* "calx.epam", "org.example.wet-hertz"; never reused */
  const char* kind; /* "calx.contact-law/1" */
  const char *name, *version, *vendor, *license, *summary; /* version: semver; license: SPDX */
  const char* const* required;                             /* host extension ids, null-terminated; may be null */
  const calx_field* parameter; /* what the user may set; schema, units and docs come from it */
  uint32_t parameter_count, reserved;
  /* JSON Schema object {"properties": {...}, "required": [...]} for what a table cannot say (lists, files), or null.
   * A string property with "format": "path" is made absolute by the host, relative to the case file. */
  const char* extra_schema;
} calx_descriptor;

typedef struct calx_config {
  uint32_t struct_size, value_count;
  const double* value; /* in parameter-table order, SI, presets filled in, ranges checked */
  const char* json;    /* object holding extra_schema's properties only, normalised; may be ignored */
  uint64_t json_size;
} calx_config;

#define CALX_FACTORY "calx.factory/1"
typedef struct calx_factory {
  uint32_t(CALX_CALL* count)(void);                              /* [any] */
  const calx_descriptor*(CALX_CALL* descriptor)(uint32_t index); /* null past the end [any] */
  /* Creating a contact law with presets always succeeds. [main] */
  calx_status(CALX_CALL* create)(const char* id, const calx_host* host, const calx_config* config, calx_instance** out);
  void(CALX_CALL* destroy)(calx_instance* instance); /* [main] */
  /* The table of the descriptor's kind, or an optional one such as "calx.state/1"; null if unknown. It may depend on
   * the instance (a law without rolling resistance has fewer history columns) and lives as long as it. [any] */
  const void*(CALX_CALL* get_interface)(calx_instance* instance, const char* interface_id);
} calx_factory;

typedef struct calx_entry {
  uint32_t magic;
  uint16_t abi_major, abi_minor;
  uint32_t struct_size, flags;
  calx_status(CALX_CALL* init)(const calx_host* host, const char* plugin_dir); /* calls nest [main] */
  void(CALX_CALL* deinit)(void);                                               /* [main] */
  const void*(CALX_CALL* get_factory)(const char* factory_id);                 /* [any] */
} calx_entry;
CALX_EXPORT extern const calx_entry calx_plugin_entry;

#ifdef __cplusplus
}
#endif
#endif
