/* spring.c: the linear spring law as a Calx plugin in plain C. The physics is in spring.law.h, compiled here in single and
 * in double precision; this file holds what the user may set and the functions Calx asks for. */
#include <calx/all.h>
#include <math.h>
#include <string.h>

#define CALX_BITS 32
#include <calx/law/prelude.h>
#include "spring.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(spring)
#undef CALX_BITS
#define CALX_BITS 64
#include <calx/law/prelude.h>
#include "spring.law.h"
#include <calx/law/native.h>
CALX_LAW_BATCH(spring)

CALX_LAW_TABLES(spring) /* spring_pair_fields, spring_prop_fields, spring_state_fields */

/* Asked of the user once per material: keys of a material in the case. */
static const calx_field material_fields[] = {
    {"moisture", "1", "mass of water per mass of solid", 0.0, 1.0, 0.0, 0, 0}};

/* Asked of the user once per pair of materials: keys of "parameters". */
static const calx_field given_fields[] = {
    {"kn", "N/m", "normal stiffness", 0.0, 1e9, 1e4, 0, 0},
    {"gn", "kg/s", "normal damping coefficient of the dry pair", 0.0, 1e6, 0.1, 0, 0},
    {"kt", "N/m", "tangential stiffness", 0.0, 1e9, 8e3, 0, 0},
    {"mu", "1", "sliding friction", 0.0, 10.0, 0.5, 0, 0}};

static const char source[] = {
#include "spring.law.h.inc"
};

/* Both materials and the given row to the pair row the law reads; once per pair, before the run. */
static calx_status CALX_CALL derive(const calx_instance* self, const calx_host* host, const double* material_i,
                                    const double* material_j, const double* given, double* pair) {
  (void)self;
  if (given[2] > given[0]) return host->fail(host, CALX_E_CONFIG, "kt is above kn; a contact is not stiffer sideways");
  pair[0] = given[0];
  /* Two saturated materials double the damping; a straight line is enough for an illustration. */
  pair[1] = given[1] * (1.0 + 0.5 * (material_i[0] + material_j[0]));
  pair[2] = given[2];
  pair[3] = given[3];
  return CALX_OK;
}

/* A tenth of the period of mass and spring, 2 pi sqrt(m / k). */
static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) {
  (void)r_eff, (void)overlap;
  return pair[0] > 0.0 ? 0.2 * 3.14159265358979324 * sqrt(m_eff / pair[0]) : HUGE_VAL;
}

static const calx_contact_law law = {
    sizeof(calx_contact_law), CALX_ABI_DRAFT, 1, CALX_LAW_EXACT, spring_NEEDS,
    /* rows of the five tables, then the tables */
    1, 4, CALX_COUNT(spring_pair_fields), CALX_COUNT(spring_prop_fields), CALX_COUNT(spring_state_fields),
    material_fields, given_fields, spring_pair_fields, spring_prop_fields, spring_state_fields,
    derive, stable_dt, 0 /* reach: acts only while touching */,
    "spring", source, sizeof source - 1,
#include "spring.law.h.sha256.inc"
    , spring_batch_f32, spring_batch_f64};

static const calx_descriptor descriptor = {
    sizeof(calx_descriptor), 0, "org.example.spring", CALX_CONTACT_LAW, "Spring", "1.0.0", "Example", "MIT",
    "Linear spring, dashpot and Coulomb slider.", 0 /* required */, 0 /* parameter */, 0, 0, 0 /* extra_schema */};

/* The law has no options, so all instances are the same and one object stands for each. */
struct calx_instance {
  char unused;
};
static struct calx_instance the_instance;

static uint32_t CALX_CALL count(void) { return 1; }
static const calx_descriptor* CALX_CALL get_descriptor(uint32_t index) { return index == 0 ? &descriptor : 0; }
static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config,
                                    calx_instance** out) {
  (void)config;
  if (strcmp(id, descriptor.id) != 0) return host->fail(host, CALX_E_UNSUPPORTED, "this library holds org.example.spring");
  *out = &the_instance;
  return CALX_OK;
}
static void CALX_CALL destroy(calx_instance* instance) { (void)instance; }
static const void* CALX_CALL get_interface(calx_instance* instance, const char* interface_id) {
  (void)instance;
  return strcmp(interface_id, CALX_CONTACT_LAW) == 0 ? &law : 0;
}

static const calx_factory factory = {count, get_descriptor, create, destroy, get_interface};

static calx_status CALX_CALL init(const calx_host* host, const char* plugin_dir) {
  (void)host, (void)plugin_dir;
  return CALX_OK;
}
static void CALX_CALL deinit(void) {}
static const void* CALX_CALL get_factory(const char* factory_id) {
  return strcmp(factory_id, CALX_FACTORY) == 0 ? &factory : 0;
}

CALX_EXPORT const calx_entry calx_plugin_entry = {
    CALX_ABI_MAGIC, CALX_ABI_MAJOR, CALX_ABI_MINOR, sizeof(calx_entry), 0, init, deinit, get_factory};
