// library.hpp: one loaded plugin library as one registry sees it, negotiated step by step (ABI: magic, major, sizes,
// init, factory, descriptors). Private to core/plugin.
#pragma once
#include <string>
#include <vector>

#include "plugin/host.hpp"
#include "plugin/loader.hpp"
#include "plugin/plugin.hpp"

namespace calx {

class PluginLibrary {
 public:
  /// pin: SHA-256 the case asks for, or empty. Throws Refused.
  PluginLibrary(const PluginManifest& manifest, const std::string& pin);
  /// One that lives in this program; name stands in messages. Throws Refused.
  PluginLibrary(const calx_entry& entry, const std::string& name);
  /// One deinit for the one init; the plugin counts them when several simulations share it.
  ~PluginLibrary();
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;

  const std::string& path() const { return path_; }
  const std::string& sha256() const { return sha256_; }
  const calx_factory& factory() const { return *factory_; }
  Host& host() { return host_; }
  /// The descriptor the manifest promises. Throws Refused: not there, another kind or version, needs what the host
  /// lacks.
  const calx_descriptor& descriptor(const PluginManifest& manifest) const;
  /// Null out with a negative status: see host().take_message(). Throws Refused when the plugin changed the
  /// floating-point mode or reported success without an instance.
  calx_status create(const calx_descriptor& descriptor, const calx_config& config, calx_instance** out);
  /// What a manifest would say of a plugin that has none.
  std::vector<PluginManifest> own_manifests() const;

 private:
  void start(const std::string& folder);
  void check_entry() const;
  void read_factory();

  std::string path_, sha256_;
  Host host_;
  const calx_entry* entry_ = nullptr;
  const calx_factory* factory_ = nullptr;
  std::vector<const calx_descriptor*> descriptors_;
};

}  // namespace calx
