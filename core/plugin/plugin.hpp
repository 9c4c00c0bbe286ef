// plugin.hpp: finds, loads and instantiates plugins. Discovery reads manifests and runs nothing; loading happens only
// for ids that a case names, from the folders given, never from the working directory.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "calx/all.h"
#include "config/config.hpp"

namespace calx {

/// One manifest NAME.plugin.json found in a search folder.
struct PluginManifest {
  std::string id, kind, version, vendor, license, summary;
  std::string library;  // absolute path of the shared library; empty for an effect of edits alone
  std::string path;     // absolute path of the manifest
  std::string sha256;   // of the library, or of the text, as the manifest states it; empty: not stated
  std::string text;     // absolute path of a law text, where the plugin has no library: the host compiles it
  std::string symbol;   // of the law in that text
  std::vector<std::string> stiffness;  // columns of the text's pair row that are stiffnesses, N/m: the stable step
  std::vector<std::string> modulus;    // columns that are effective moduli of a Hertz law, Pa: the same
  std::vector<std::string> reach;      // columns of it that are gaps up to which the law acts, m
  std::vector<std::string> examples;   // JSON objects of parameters that `calx plugin check` tries besides presets
  bool open = false;                   // a geometry whose surface has rims on purpose
  bool pulls = false;                  // a law whose normal force pulls on purpose, the more the larger the overlap
  std::string refused;  // why it cannot be used (bad manifest, duplicate id, other architecture); empty: usable
  std::shared_ptr<const EffectInfo> effect{};  // what it says of itself as an effect (effects.hpp); null: it is none
};

/// Search folders in order: given, CALX_PLUGIN_PATH (secure_getenv), $XDG_DATA_HOME/calx/plugins, then those that were
/// installed with the program. Canonical, each once, only those that exist.
/// Throws Error(Fault::files) for a given folder that does not exist and for a relative one in CALX_PLUGIN_PATH.
std::vector<std::string> plugin_search_path(const std::vector<std::string>& given);

/// Where Calx is installed, or its build tree: above the folder of the program. Empty where that cannot be told.
std::string program_prefix();

/// Folders that came with the program: beside it (build tree: <dir of calx>/../plugins) and <prefix>/lib/calx/plugins.
/// Canonical, only those that exist.
std::vector<std::string> installed_plugin_folders();

/// All manifests in the folders, sorted within each folder; of a duplicate id the first wins, the others are refused.
std::vector<PluginManifest> discover_plugins(const std::vector<std::string>& path);

/// What the folder of a case may add: plugins that are a law text, never a library. Of an id that stands in found
/// already, or twice, the later one is refused.
void add_text_plugins(const std::string& folder, std::vector<PluginManifest>& found);

class PluginLibrary;

/// A created plugin instance; destroyed with the last owner. Tables live as long as it.
class PluginInstance {
 public:
  PluginInstance(std::shared_ptr<PluginLibrary> library, calx_instance* instance, const calx_descriptor* descriptor);
  ~PluginInstance();
  PluginInstance(const PluginInstance&) = delete;
  PluginInstance& operator=(const PluginInstance&) = delete;
  calx_instance* get() const { return instance_; }
  const calx_descriptor& descriptor() const { return *descriptor_; }
  /// The table of that id, or null.
  const void* table(const char* interface_id) const;
  const calx_host* host() const;
  /// "calx.epam 1.0.0", for messages.
  std::string label() const;
  /// Throws for a negative status, with the message the plugin left through host->fail: Fault::settings for
  /// CALX_E_CONFIG (the case is wrong), else Fault::plugin. doing: what was called, "build". Call it right after.
  void check(calx_status status, const std::string& file, const std::string& pointer, const std::string& doing) const;

 private:
  std::shared_ptr<PluginLibrary> library_;
  calx_instance* instance_;
  const calx_descriptor* descriptor_;
};
using InstancePtr = std::shared_ptr<PluginInstance>;

/// What a run's provenance says of one loaded plugin.
struct PluginProvenance {
  std::string id, version, sha256, path;
};

/// What a registry takes besides libraries of its search folders.
struct PluginTrust {
  bool pins_required = false;  // refuse what the case does not pin
  std::string text_folder;     // of the case: plugins there that are a law text; empty: none
};

/// One per simulation: ids to loaded libraries. A library that this process has not met is loaded, initialised and
/// asked for an instance in a child process first, so that one that crashes, hangs or exits there is refused. [main]
class PluginRegistry {
 public:
  /// search: the folders, usually from plugin_search_path. pins: id and sha256 that must match.
  explicit PluginRegistry(const std::vector<std::string>& search,
                          std::vector<std::pair<std::string, std::string>> pins = {}, const PluginTrust& trust = {});
  ~PluginRegistry();

  /// Plugins that live in this program, before any of the same id in a folder; entry outlives the registry. name stands
  /// in messages, as a path does for others. Throws Error(Fault::plugin) where it is refused.
  void add(const calx_entry& entry, const std::string& name);

  /// Loads the library of id if needed, in the order of ABI.md section 3 (manifest, load, symbol, magic, major, sizes,
  /// init, factory, descriptors, required extensions), and returns its descriptor. pointer: JSON pointer where the case
  /// names it. Throws Error(Fault::plugin): not found (nearest id and the folders searched), refused (why), wrong kind.
  const calx_descriptor& load(const std::string& id, const std::string& kind, const std::string& file,
                              const std::string& pointer);

  /// load + resolve parameters of the descriptor + create_with_values. ignore_keys: keys of the JSON object that belong
  /// to other tables. Throws what they throw.
  InstancePtr create(const std::string& id, const std::string& kind, const Parameters& parameters,
                     const std::string& file, const std::vector<std::string>& ignore_keys = {});

  /// load + create + check of the table (draft, size, functions, fields). values: of the descriptor's parameter table,
  /// in its order, SI; json: what extra_schema allows. Throws Error(Fault::settings) with the plugin's own message
  /// where it finds the case wrong, else Error(Fault::plugin).
  InstancePtr create_with_values(const std::string& id, const std::string& kind, const std::string& file,
                                 const std::string& pointer, const std::vector<double>& values,
                                 const std::string& json = "{}");

  /// Kind of the usable plugin of that id; empty: none. Reads manifests only.
  std::string kind_of(const std::string& id) const;
  const std::vector<PluginManifest>& manifests() const;
  /// Of every id loaded, sorted by id.
  std::vector<PluginProvenance> provenance() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Text of `calx plugin list`, `describe ID`, `schema ID`. list reads manifests only; the other two load the one
/// library. Throw Error(Fault::plugin) as PluginRegistry::load does.
std::string plugin_list_text(const std::vector<std::string>& search);
std::string plugin_describe_text(const std::string& id, const std::vector<std::string>& search);
std::string plugin_schema_text(const std::string& id, const std::vector<std::string>& search);

}  // namespace calx
