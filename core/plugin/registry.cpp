// registry.cpp: from the ids a case names to loaded libraries and instances.
#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "plugin/library.hpp"
#include "plugin/plugin.hpp"
#include "plugin/refused.hpp"
#include "plugin/tables.hpp"

namespace calx {
namespace {

std::string joined(const std::vector<std::string>& folders) {
  std::string out;
  for (const std::string& folder : folders) out += (out.empty() ? "" : ", ") + folder;
  return out.empty() ? "no folder" : out;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

}  // namespace

struct PluginRegistry::Impl {
  std::vector<std::string> search;
  std::map<std::string, std::string> pins;
  bool pins_required = false;
  std::vector<PluginManifest> manifests;
  std::map<std::string, std::shared_ptr<PluginLibrary>> libraries;  // by path
  std::map<std::string, PluginProvenance> loaded;                   // by id

  /// What helps to find id: often the folder above was named, that of a project or of its build.
  std::string advice(const std::string& id) const {
    for (const std::string& folder : search)
      for (const char* below : {"/plugins", "/build/plugins"})
        for (const PluginManifest& m : discover_plugins({folder + below}))
          if (m.id == id) return folder + below + " holds it: --plugin-path " + folder + below;
    return "name its folder with --plugin-path";
  }

  /// The usable manifest of id and kind. Throws Refused or Error.
  const PluginManifest& find(const std::string& id, const std::string& kind, const std::string& where) const {
    const PluginManifest* refused = nullptr;
    std::vector<std::string> known;
    for (const PluginManifest& m : manifests) {
      if (m.id == id && m.refused.empty()) {
        if (m.kind != kind)
          throw Error(Fault::plugin,
                      where + "plugin " + id + " is of the kind " + m.kind + ", but " + kind + " is wanted here");
        return m;
      }
      if (m.id == id && !refused) refused = &m;
      // A servo may stand where a motion does.
      const bool fits = m.kind == kind || (kind == CALX_MOTION && m.kind == CALX_SERVO);
      if (m.refused.empty() && fits) known.push_back(m.id);
    }
    if (refused) throw Refused{refused->refused};
    const std::string near = nearest_name(id, known);
    std::string bad;
    for (const PluginManifest& m : manifests)
      if (m.id.empty()) bad += "; " + m.refused;
    throw Error(Fault::plugin, where + "no plugin " + id + " of the kind " + kind + " found in " + joined(search) +
                                   (near.empty() ? "; " + advice(id) : "; did you mean \"" + near + "\"?") + bad);
  }

  std::shared_ptr<PluginLibrary> library(const PluginManifest& manifest) {
    const std::string& file = manifest.text.empty() ? manifest.library : manifest.text;
    const auto pin = pins.find(manifest.id);
    const std::string wanted = pin == pins.end() ? "" : pin->second;
    // What lives in this program has no file, and its word is that of the program.
    if (wanted.empty() && pins_required && file.front() == '/') {
      const std::string hash = LibraryFile(file).sha256();
      throw Refused{"the case does not pin it, and pins are required; add \"plugins\": {\"" + manifest.id +
                    "\": {\"sha256\": \"" + hash + "\"}} to the case if you trust " + file};
    }
    // Each text is a library of its own; a library may hold several plugins.
    const std::string key = manifest.text.empty() ? file : file + " " + manifest.id;
    const auto open = libraries.find(key);
    if (open != libraries.end()) {
      if (!wanted.empty() && wanted != open->second->sha256())
        throw Refused{file + " has SHA-256 " + open->second->sha256() + ", but the case pins " + wanted};
      return open->second;
    }
    auto fresh = std::make_shared<PluginLibrary>(manifest, wanted);
    libraries.emplace(key, fresh);
    return fresh;
  }

  struct Loaded {
    std::shared_ptr<PluginLibrary> library;
    const calx_descriptor* descriptor;
  };
  Loaded load(const std::string& id, const std::string& kind, const std::string& where) {
    try {
      const PluginManifest& manifest = find(id, kind, where);
      Loaded out{library(manifest), nullptr};
      out.descriptor = &out.library->descriptor(manifest);
      loaded[id] = {id, out.descriptor->version, out.library->sha256(), out.library->path()};
      return out;
    } catch (const Refused& refused) {
      throw refusal(id, where, refused);
    }
  }

  static Error refusal(const std::string& id, const std::string& where, const Refused& refused) {
    return Error(Fault::plugin, where + "plugin " + id + " refused: " + refused.reason);
  }
};

PluginRegistry::PluginRegistry(const std::vector<std::string>& search,
                               std::vector<std::pair<std::string, std::string>> pins, const PluginTrust& trust)
    : impl_(new Impl) {
  impl_->pins_required = trust.pins_required;
  impl_->search = search;
  for (const auto& pin : pins) impl_->pins[pin.first] = lower(pin.second);
  impl_->manifests = discover_plugins(search);
  if (!trust.text_folder.empty()) add_text_plugins(trust.text_folder, impl_->manifests);
}

PluginRegistry::~PluginRegistry() = default;

void PluginRegistry::add(const calx_entry& entry, const std::string& name) {
  try {
    const auto library = std::make_shared<PluginLibrary>(entry, name);
    impl_->libraries.emplace(name, library);
    const std::vector<PluginManifest> own = library->own_manifests();
    impl_->manifests.insert(impl_->manifests.begin(), own.begin(), own.end());
  } catch (const Refused& refused) {
    throw Error(Fault::plugin, "refused: " + refused.reason);
  }
}

const calx_descriptor& PluginRegistry::load(const std::string& id, const std::string& kind, const std::string& file,
                                            const std::string& pointer) {
  return *impl_->load(id, kind, place(file, pointer)).descriptor;
}

InstancePtr PluginRegistry::create(const std::string& id, const std::string& kind, const Parameters& parameters,
                                   const std::string& file, const std::vector<std::string>& ignore_keys) {
  // The id stands beside the parameters.
  const std::string owner = parameters.pointer.substr(0, parameters.pointer.rfind("/parameters"));
  const calx_descriptor& d = load(id, kind, file, owner);
  const ResolvedParameters resolved = resolve_parameters(parameters, {{d.parameter, d.parameter_count}}, d.extra_schema,
                                                         id + " " + d.version, file, ignore_keys);
  return create_with_values(id, kind, file, parameters.pointer, resolved.values.at(0), resolved.extra_json);
}

InstancePtr PluginRegistry::create_with_values(const std::string& id, const std::string& kind, const std::string& file,
                                               const std::string& pointer, const std::vector<double>& values,
                                               const std::string& json) {
  const std::string where = place(file, pointer);
  const Impl::Loaded from = impl_->load(id, kind, where);
  const calx_descriptor& d = *from.descriptor;
  if (values.size() != d.parameter_count)
    throw Error(Fault::plugin, where + "plugin " + id + " takes " + std::to_string(d.parameter_count) + " values, " +
                                   std::to_string(values.size()) + " given");
  const calx_config config = {sizeof(calx_config), d.parameter_count, values.data(), json.c_str(), json.size()};
  try {
    calx_instance* made = nullptr;
    const calx_status status = from.library->create(d, config, &made);
    if (status < 0) {
      const std::string message = from.library->host().take_message(status);
      if (status == CALX_E_CONFIG) throw Error(Fault::settings, where + id + " " + d.version + ": " + message);
      throw Refused{from.library->path() + ": create failed with " + status_name(status) + ": " + message};
    }
    auto instance = std::make_shared<PluginInstance>(from.library, made, &d);
    std::string fault = interface_fault(kind, instance->table(kind.c_str()));
    const void* state = instance->table(CALX_STATE);  // optional, but for servos
    if (fault.empty() && (state || kind == CALX_SERVO)) fault = interface_fault(CALX_STATE, state);
    if (!fault.empty()) throw Refused{from.library->path() + ": " + fault};
    return instance;
  } catch (const Refused& refused) {
    throw Impl::refusal(id, where, refused);
  }
}

std::string PluginRegistry::kind_of(const std::string& id) const {
  for (const PluginManifest& m : impl_->manifests)
    if (m.id == id && m.refused.empty()) return m.kind;
  return "";
}

const std::vector<PluginManifest>& PluginRegistry::manifests() const { return impl_->manifests; }

std::vector<PluginProvenance> PluginRegistry::provenance() const {
  std::vector<PluginProvenance> out;
  for (const auto& one : impl_->loaded) out.push_back(one.second);
  return out;
}

}  // namespace calx
