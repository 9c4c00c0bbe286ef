/* golden_law.c: the plugin test.golden-law in C99, against the headers of ABI 1.0. golden_law.so beside it was built
 * from this text once, by build.sh, and is never built again: it stands for the plugins that exist when a later Calx
 * comes out. What it does: golden_law.law.h. */
#include <calx/all.h>
#include <stddef.h>

#define CALX_BITS 32
#include <calx/law/native.h>
#include <calx/law/prelude.h>

#include "golden_law.law.h"
CALX_LAW_BATCH(golden_law)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/native.h>
#include <calx/law/prelude.h>

#include "golden_law.law.h"
CALX_LAW_BATCH(golden_law)
CALX_LAW_TABLES(golden_law)

static const char source[] = {
#include "golden_law.law.h.inc"
};

static int same(const char* a, const char* b) {
  while (*a && *a == *b) ++a, ++b;
  return *a == *b;
}

/* What the user sets: the pair row, the string's tension times an option of the law. */
static const calx_field options[] = {
    {"strings", "1", "strings of each contact", 0.0, 100.0, 1.0, CALX_FIELD_INTEGER, 0}};

struct calx_instance {
  double strings;
};
static struct calx_instance instances[64];
static uint32_t used;

static calx_status CALX_CALL derive(const calx_instance* self, const calx_host* host, const double* material_i,
                                    const double* material_j, const double* given, double* pair) {
  (void)host, (void)material_i, (void)material_j;
  pair[0] = given[0];
  pair[1] = given[1] * self->strings;
  pair[2] = given[2];
  return CALX_OK;
}
static double CALX_CALL reach(const double* pair, double r_i, double r_j) {
  (void)r_i, (void)r_j;
  return pair[2];
}

#define ROWS(table) (sizeof(table) / sizeof((table)[0]) - 1)
static const calx_contact_law law = {sizeof(calx_contact_law),
                                     0,
                                     1,
                                     CALX_LAW_EXACT,
                                     golden_law_NEEDS,
                                     0,
                                     ROWS(golden_law_pair_fields),
                                     ROWS(golden_law_pair_fields),
                                     0,
                                     ROWS(golden_law_state_fields),
                                     0,
                                     golden_law_pair_fields,
                                     golden_law_pair_fields,
                                     golden_law_prop_fields,
                                     golden_law_state_fields,
                                     derive,
                                     0,
                                     reach,
                                     "golden_law",
                                     source,
                                     sizeof source - 1,
#include "golden_law.law.h.sha256.inc"
                                     ,
                                     golden_law_batch_f32,
                                     golden_law_batch_f64};

static const calx_descriptor descriptor = {sizeof(calx_descriptor),
                                           0,
                                           "test.golden-law",
                                           CALX_CONTACT_LAW,
                                           "Golden law",
                                           "1.0.0",
                                           "Calx",
                                           "Apache-2.0",
                                           "A spring and a string, as they were built for ABI 1.0.",
                                           0,
                                           options,
                                           1,
                                           0,
                                           0};

static uint32_t CALX_CALL count(void) { return 1; }
static const calx_descriptor* CALX_CALL get_descriptor(uint32_t index) { return index == 0 ? &descriptor : 0; }
static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config,
                                    calx_instance** out) {
  if (!same(id, descriptor.id)) return host->fail(host, CALX_E_UNSUPPORTED, "this library holds test.golden-law");
  if (used == sizeof instances / sizeof *instances) return host->fail(host, CALX_E_MEMORY, "too many golden laws");
  instances[used].strings = config->value[0];
  *out = &instances[used++];
  return CALX_OK;
}
static void CALX_CALL destroy(calx_instance* instance) { (void)instance; }
static const void* CALX_CALL get_interface(calx_instance* instance, const char* id) {
  (void)instance;
  return same(id, CALX_CONTACT_LAW) ? &law : 0;
}
static const calx_factory factory = {count, get_descriptor, create, destroy, get_interface};

static calx_status CALX_CALL init(const calx_host* host, const char* plugin_dir) {
  (void)host, (void)plugin_dir;
  return CALX_OK;
}
static void CALX_CALL deinit(void) {}
static const void* CALX_CALL get_factory(const char* id) { return same(id, CALX_FACTORY) ? &factory : 0; }

const calx_entry calx_plugin_entry = {CALX_ABI_MAGIC, 1, 0, sizeof(calx_entry), 0, init, deinit, get_factory};
