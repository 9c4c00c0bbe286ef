/* bad_plugin.h: a correct particle force, each part of which the including file may replace by a macro with what it
 * does wrong or otherwise. */
#include <calx/all.h>
#include <string.h>

#ifndef BAD_MAGIC
#define BAD_MAGIC CALX_ABI_MAGIC
#endif
#ifndef BAD_MAJOR
#define BAD_MAJOR CALX_ABI_MAJOR
#endif
#ifndef BAD_ENTRY_SIZE
#define BAD_ENTRY_SIZE sizeof(calx_entry)
#endif
#ifndef BAD_DRAFT
#define BAD_DRAFT CALX_ABI_DRAFT
#endif
#ifndef BAD_TABLE_SIZE
#define BAD_TABLE_SIZE sizeof(calx_particle_force)
#endif
#ifndef BAD_KIND
#define BAD_KIND CALX_PARTICLE_FORCE
#endif
#ifndef BAD_EVAL
#define BAD_EVAL eval
#endif
#ifndef BAD_TABLE
#define BAD_TABLE &table
#endif
#ifndef BAD_FACTORY
#define BAD_FACTORY &factory
#endif
#ifndef BAD_REQUIRED
#define BAD_REQUIRED 0
#endif
#ifndef BAD_INIT
#define BAD_INIT return CALX_OK
#endif
#ifndef BAD_DEINIT
#define BAD_DEINIT
#endif
#ifndef BAD_CREATE
#define BAD_CREATE      \
  *out = &the_instance; \
  return CALX_OK
#endif

struct calx_instance {
  char unused;
};
static struct calx_instance the_instance;

#ifndef BAD_OWN_EVAL
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) { (void)self, (void)block; }
#endif
static const calx_particle_force table = {BAD_TABLE_SIZE, BAD_DRAFT, BAD_EVAL, 0, 0, 0, 0, 0, 0, 0, 0};

static const calx_descriptor descriptor = {sizeof(calx_descriptor),
                                           0,
                                           BAD_ID,
                                           BAD_KIND,
                                           "Bad",
                                           "1.0.0",
                                           "Calx",
                                           "Apache-2.0",
                                           "A plugin for tests.",
                                           BAD_REQUIRED,
                                           0,
                                           0,
                                           0,
                                           0};

static uint32_t CALX_CALL count(void) { return 1; }
static const calx_descriptor* CALX_CALL get_descriptor(uint32_t index) { return index == 0 ? &descriptor : 0; }
static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config,
                                    calx_instance** out) {
  (void)config, (void)out, (void)the_instance;
  if (strcmp(id, BAD_ID) != 0) return host->fail(host, CALX_E_UNSUPPORTED, "this library holds another plugin");
  BAD_CREATE;
}
static void CALX_CALL destroy(calx_instance* instance) { (void)instance; }
static const void* CALX_CALL get_interface(calx_instance* instance, const char* interface_id) {
  (void)instance, (void)table;
  return strcmp(interface_id, BAD_KIND) == 0 ? BAD_TABLE : 0;
}
static const calx_factory factory = {count, get_descriptor, create, destroy, get_interface};

static calx_status CALX_CALL init(const calx_host* host, const char* plugin_dir) {
  (void)host, (void)plugin_dir;
  BAD_INIT;
}
static void CALX_CALL deinit(void) { BAD_DEINIT; }
static const void* CALX_CALL get_factory(const char* factory_id) {
  (void)factory;
#ifdef BAD_ANY_ID
  (void)factory_id;
  return BAD_FACTORY;
#else
  return strcmp(factory_id, CALX_FACTORY) == 0 ? BAD_FACTORY : 0;
#endif
}

const calx_entry calx_plugin_entry = {BAD_MAGIC, BAD_MAJOR, CALX_ABI_MINOR, BAD_ENTRY_SIZE,
                                      0,         init,      deinit,         get_factory};
