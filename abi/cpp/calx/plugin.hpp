// SPDX-License-Identifier: MIT
// calx/plugin.hpp: optional C++11 helper for plugin authors; header only. It writes entry, factory and life cycle, and
// keeps exceptions inside the plugin.
//
// A plugin is a class derived from calx::Instance:
//   class Box : public calx::Instance {
//    public:
//     static const calx_descriptor descriptor;                       // id, kind, parameter table
//     Box(const calx_host* host, const calx_config& config);         // may throw calx::ConfigError("why")
//     const void* get_interface(const char* id) const override;      // the table of its kind
//   };
//   CALX_PLUGIN(Box)            // or CALX_PLUGIN(Box, Cylinder, ...): one library may hold several
#ifndef CALX_PLUGIN_HPP
#define CALX_PLUGIN_HPP
#include <calx/all.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

// The ABI's opaque instance, given a body for C++ plugins.
struct calx_instance {
  virtual ~calx_instance() {}
  virtual const void* get_interface(const char* id) const = 0;
};

namespace calx {

typedef calx_instance Instance;

/// The user's case is wrong; the message names the key, the value and what would be right.
struct ConfigError : std::runtime_error {
  explicit ConfigError(const std::string& message) : std::runtime_error(message) {}
};

/// Runs f; turns exceptions into a status with a message.
template <class F>
calx_status guard(const calx_host* host, F f) noexcept {
  try {
    f();
    return CALX_OK;
  } catch (const ConfigError& e) {
    return host->fail(host, CALX_E_CONFIG, e.what());
  } catch (const std::bad_alloc&) {
    return host->fail(host, CALX_E_MEMORY, "out of memory");
  } catch (const std::exception& e) {
    return host->fail(host, CALX_E_INTERNAL, e.what());
  } catch (...) {
    return host->fail(host, CALX_E_INTERNAL, "unknown exception");
  }
}

namespace detail {

struct Maker {
  const calx_descriptor* descriptor;
  calx_instance* (*make)(const calx_host*, const calx_config&);
};

template <class T>
struct Make {
  static calx_instance* make(const calx_host* host, const calx_config& config) { return new T(host, config); }
};

template <class... Types>
struct Factory {
  static const Maker* makers() noexcept {
    static const Maker list[] = {{&Types::descriptor, &Make<Types>::make}..., {0, 0}};
    return list;
  }
  static uint32_t CALX_CALL count() noexcept { return sizeof...(Types); }
  static const calx_descriptor* CALX_CALL descriptor(uint32_t index) noexcept {
    return index < sizeof...(Types) ? makers()[index].descriptor : 0;
  }
  static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config,
                                      calx_instance** out) noexcept {
    if (!id || !host || !config || !out) return CALX_E_ARGUMENT;
    for (const Maker* m = makers(); m->descriptor; ++m)
      if (std::strcmp(m->descriptor->id, id) == 0) return guard(host, [&] { *out = m->make(host, *config); });
    return host->fail(host, CALX_E_UNSUPPORTED, "this library holds no plugin of that id");
  }
  static void CALX_CALL destroy(calx_instance* instance) noexcept { delete instance; }
  static const void* CALX_CALL get_interface(calx_instance* instance, const char* id) noexcept {
    return instance && id ? instance->get_interface(id) : 0;
  }
  static const void* CALX_CALL get_factory(const char* id) noexcept {
    static const calx_factory factory = {&count, &descriptor, &create, &destroy, &get_interface};
    return id && std::strcmp(id, CALX_FACTORY) == 0 ? &factory : 0;
  }
  static calx_status CALX_CALL init(const calx_host*, const char*) noexcept { return CALX_OK; }
  static void CALX_CALL deinit() noexcept {}
};

}  // namespace detail

/// Value of a parameter by name, from a descriptor's table. Throws std::logic_error for a name the table lacks.
inline double parameter(const calx_descriptor& d, const calx_config& config, const char* name) {
  for (uint32_t k = 0; k < d.parameter_count && k < config.value_count; ++k)
    if (std::strcmp(d.parameter[k].name, name) == 0) return config.value[k];
  throw std::logic_error(std::string("the parameter table has no field ") + name);
}

}  // namespace calx

#define CALX_PLUGIN(...)                                                                   \
  extern "C" {                                                                             \
  CALX_EXPORT extern const calx_entry calx_plugin_entry;                                   \
  const calx_entry calx_plugin_entry = {CALX_ABI_MAGIC,                                    \
                                        CALX_ABI_MAJOR,                                    \
                                        CALX_ABI_MINOR,                                    \
                                        sizeof(calx_entry),                                \
                                        0,                                                 \
                                        &calx::detail::Factory<__VA_ARGS__>::init,         \
                                        &calx::detail::Factory<__VA_ARGS__>::deinit,       \
                                        &calx::detail::Factory<__VA_ARGS__>::get_factory}; \
  }
#endif
