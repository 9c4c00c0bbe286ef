/* newer_minor.c: a plugin as a later release of the boundary, 1.1, might have it: structs that have grown, ids and
 * flags that this host does not know. It must load here and do what ABI 1.0 lets it do: a constant acceleration along
 * x. NEWER_NEEDS: a host extension that 1.0 lacks, which must be refused. */
#include <calx/all.h>
#include <string.h>

/* 1.0, and what has come at the tail. */
typedef struct newer_host {
  calx_host old;
  const char* build;
} newer_host;
typedef struct newer_config {
  calx_config old;
  const char* case_file;
} newer_config;
typedef struct newer_descriptor {
  calx_descriptor old;
  const char *homepage, *icon;
} newer_descriptor;
typedef struct newer_entry {
  calx_entry old;
  calx_status(CALX_CALL* idle)(void);
} newer_entry;
#define NEWER_FIELD_SECRET (1u << 6)

struct calx_instance {
  double acceleration;
};
static struct calx_instance the_instance;

static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) {
  uint32_t k;
  for (k = 0; k < block->count; ++k) block->fx[k] += block->mass[k] * self->acceleration;
}
static const calx_particle_force table = {sizeof(calx_particle_force), 0, eval, 0, 0, 0, 0, 0, 0, 0, 0};

static const calx_field parameters[] = {
    {"acceleration", "m/s^2", "along x", -100.0, 100.0, 1.0, NEWER_FIELD_SECRET, 7}};
#ifdef NEWER_NEEDS
static const char* const required[] = {"calx.host.weather/1", 0};
#else
#define required 0
#endif
static const newer_descriptor descriptor = {
    {sizeof(newer_descriptor), 0xFFFF0000u, NEWER_ID, CALX_PARTICLE_FORCE, "Newer", "1.0.0", "Calx", "Apache-2.0",
     "A constant acceleration, from a later release.", required, parameters, 1, 0xFFFFFFFFu, 0},
    "https://example.org",
    "newer.svg"};

static uint32_t CALX_CALL count(void) { return 1; }
static const calx_descriptor* CALX_CALL get_descriptor(uint32_t index) { return index == 0 ? &descriptor.old : 0; }
static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config,
                                    calx_instance** out) {
  /* What this host does not have is not read: its structs say how large they are. */
  if (host->struct_size >= sizeof(newer_host) || config->struct_size >= sizeof(newer_config))
    return host->fail(host, CALX_E_INTERNAL, "this host has grown; the test stands for one that has not");
  if (host->get_extension(host, "calx.host.weather/1"))
    return host->fail(host, CALX_E_INTERNAL, "this host knows the weather");
  if (strcmp(id, NEWER_ID) != 0) return host->fail(host, CALX_E_UNSUPPORTED, "another plugin");
  the_instance.acceleration = config->value[0];
  *out = &the_instance;
  return CALX_OK;
}
static void CALX_CALL destroy(calx_instance* instance) { (void)instance; }
static const void* CALX_CALL get_interface(calx_instance* instance, const char* id) {
  static const char newer_table[256];
  (void)instance;
  if (strcmp(id, "calx.particle-force/2") == 0) return newer_table;
  return strcmp(id, CALX_PARTICLE_FORCE) == 0 ? (const void*)&table : 0;
}
static const calx_factory factory = {count, get_descriptor, create, destroy, get_interface};

static calx_status CALX_CALL init(const calx_host* host, const char* plugin_dir) {
  (void)host, (void)plugin_dir;
  return CALX_OK;
}
static void CALX_CALL deinit(void) {}
static calx_status CALX_CALL idle(void) { return CALX_OK; }
static const void* CALX_CALL get_factory(const char* id) { return strcmp(id, CALX_FACTORY) == 0 ? &factory : 0; }

/* The header declares the entry in its size of 1.0. */
CALX_EXPORT extern const newer_entry larger_entry __asm__("calx_plugin_entry");
const newer_entry larger_entry = {
    {CALX_ABI_MAGIC, CALX_ABI_MAJOR, CALX_ABI_MINOR + 1, sizeof(newer_entry), 0, init, deinit, get_factory}, idle};
