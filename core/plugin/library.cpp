#include "plugin/library.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "plugin/child.hpp"
#include "plugin/float_mode.hpp"
#include "plugin/law_lint.hpp"
#include "plugin/refused.hpp"
#include "plugin/tables.hpp"
#include "plugin/text_plugin.hpp"

namespace calx {
namespace {

std::string hex(std::uint32_t value) {
  char out[16];
  std::snprintf(out, sizeof out, "0x%08x", static_cast<unsigned>(value));
  return out;
}

/// Wall time for a first contact, s: enough for a plugin that reads large files on a busy machine.
constexpr double kFirstContactLimit = 60;

/// Calls into the plugin; a changed floating-point mode is put back and refused.
template <class Call>
auto guarded(const std::string& path, const char* during, Call call) {
  const FloatMode before = FloatMode::now();
  const auto result = call();
  const FloatMode after = FloatMode::now();
  if (after != before) {
    before.restore();
    throw Refused{path + " changed the floating-point mode of the process in " + during + " (" + before.text() +
                  " became " + after.text() + ")"};
  }
  return result;
}

std::recursive_mutex& first_contact() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// The first contact with foreign code happens in a child process; only what kills or blocks that is told here, for all
/// else shows again, with its own message, in this process.
void try_in_child(const std::string& path, const char* when, Host& host, const std::function<void()>& contact) {
  // Taken where libraries are loaded, too: a child must not inherit a lock that a thread of its parent holds.
  const std::lock_guard<std::recursive_mutex> one_at_a_time(first_contact());
  const ChildOutcome outcome = run_in_child(
      [&] {
        host.be_silent();  // what it logs is logged when this process meets it
        try {
          contact();
        } catch (const Refused&) {
        }
        return std::string();
      },
      kFirstContactLimit);
  // Where no child can be started the plugin is not refused for it.
  if (outcome.answered() || outcome.end == ChildOutcome::End::not_started) return;
  throw Refused{path + " " + outcome.text() + " when it " + when +
                "; this was tried in a process of its own, so nothing else was harmed"};
}

/// Configurations that have made an instance in a child: library, id, values and JSON.
bool is_new_configuration(const std::string& key) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  const std::lock_guard<std::mutex> lock(mutex);
  return seen.insert(key).second;
}

}  // namespace

PluginLibrary::PluginLibrary(const PluginManifest& manifest, const std::string& pin, bool in_child)
    : path_(manifest.text.empty() ? manifest.library : manifest.text),
      in_child_(in_child || !manifest.text.empty()),
      host_(std::filesystem::path(path_).stem().string()) {
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  LibraryFile file(path_);
  sha256_ = file.sha256();
  if (!manifest.sha256.empty() && manifest.sha256 != sha256_)
    throw Refused{path_ + " has SHA-256 " + sha256_ + ", but its manifest says " + manifest.sha256};
  if (!pin.empty() && pin != sha256_) throw Refused{path_ + " has SHA-256 " + sha256_ + ", but the case pins " + pin};
  if (!manifest.text.empty()) {
    entry_ = &compile_text_plugin(manifest, file.content(kLawTextLimit));
    start(folder);
    return;
  }
  const std::lock_guard<std::recursive_mutex> one_at_a_time(first_contact());
  if (!in_child_ && !file.is_known())
    try_in_child(path_, "was loaded and initialised", host_, [&] {
      entry_ = &file.load();
      start(folder);
      entry_->deinit();
    });
  entry_ = &file.load();
  start(folder);
}

PluginLibrary::PluginLibrary(const calx_entry& entry, const std::string& name)
    : path_(name), in_child_(true), host_(name), entry_(&entry) {
  start("");
}

void PluginLibrary::start(const std::string& folder) {
  check_entry();
  const calx_status status = guarded(path_, "init", [&] { return entry_->init(host_.table(), folder.c_str()); });
  if (status < 0)
    throw Refused{path_ + ": init failed with " + status_name(status) + ": " + host_.take_message(status)};
  try {
    read_factory();
  } catch (...) {
    entry_->deinit();
    throw;
  }
}

PluginLibrary::~PluginLibrary() { entry_->deinit(); }

void PluginLibrary::check_entry() const {
  if (entry_->magic != CALX_ABI_MAGIC)
    throw Refused{path_ + ": calx_plugin_entry begins with " + hex(entry_->magic) + " instead of " +
                  hex(CALX_ABI_MAGIC) + "; it is no Calx plugin, or built for another byte order"};
  if (entry_->abi_major != CALX_ABI_MAJOR)
    throw Refused{path_ + " was built for ABI " + std::to_string(entry_->abi_major) + "." +
                  std::to_string(entry_->abi_minor) + ", this host speaks ABI " + abi_version() + ": rebuild it"};
  // The size of release 1.0; later releases may only add behind get_factory.
  constexpr std::uint32_t needed = offsetof(calx_entry, get_factory) + sizeof(void*);
  if (entry_->struct_size < needed)
    throw Refused{path_ + ": calx_plugin_entry has " + std::to_string(entry_->struct_size) + " bytes, ABI 1.0 needs " +
                  std::to_string(needed) + ": rebuild it"};
  const char* missing = !entry_->init          ? "init"
                        : !entry_->deinit      ? "deinit"
                        : !entry_->get_factory ? "get_factory"
                                               : nullptr;
  if (missing) throw Refused{path_ + ": calx_plugin_entry lacks " + missing};
}

void PluginLibrary::read_factory() {
  factory_ = static_cast<const calx_factory*>(entry_->get_factory(CALX_FACTORY));
  if (!factory_) throw Refused{path_ + ": has no factory " CALX_FACTORY};
  const char* missing = !factory_->count           ? "count"
                        : !factory_->descriptor    ? "descriptor"
                        : !factory_->create        ? "create"
                        : !factory_->destroy       ? "destroy"
                        : !factory_->get_interface ? "get_interface"
                                                   : nullptr;
  if (missing) throw Refused{path_ + ": its factory lacks " + missing};
  const std::uint32_t count = factory_->count();
  if (count > 1024) throw Refused{path_ + ": its factory announces " + std::to_string(count) + " plugins"};
  for (std::uint32_t k = 0; k < count; ++k) {
    const calx_descriptor* d = factory_->descriptor(k);
    if (!d)
      throw Refused{path_ + ": its factory announces " + std::to_string(count) + " plugins, but descriptor " +
                    std::to_string(k) + " is null"};
    const std::string fault = descriptor_fault(*d);
    if (!fault.empty()) throw Refused{path_ + ": " + fault};
    descriptors_.push_back(d);
  }
}

const calx_descriptor& PluginLibrary::descriptor(const PluginManifest& manifest) const {
  const auto found = std::find_if(descriptors_.begin(), descriptors_.end(),
                                  [&](const calx_descriptor* d) { return manifest.id == d->id; });
  if (found == descriptors_.end()) {
    std::vector<std::string> ids;
    for (const calx_descriptor* d : descriptors_) ids.push_back(d->id);
    throw Refused{path_ + " holds no plugin " + manifest.id + ", although " + manifest.path + " says so; it holds " +
                  (ids.empty() ? "none" : quoted_list(ids))};
  }
  const calx_descriptor& d = **found;
  if (manifest.kind != d.kind)
    throw Refused{path_ + " says " + manifest.id + " is of the kind " + d.kind + ", but " + manifest.path + " says " +
                  manifest.kind};
  if (manifest.version != d.version)
    throw Refused{path_ + " holds version " + d.version + " of " + manifest.id + ", but " + manifest.path + " says " +
                  manifest.version};
  for (const char* const* id = d.required; id && *id; ++id) {
    const auto& offered = host_extensions();
    if (std::find(offered.begin(), offered.end(), *id) == offered.end())
      throw Refused{path_ + ": " + manifest.id + " needs the host extension " + *id +
                    ", which this host lacks; it has " + quoted_list(offered)};
  }
  return d;
}

std::vector<PluginManifest> PluginLibrary::own_manifests() const {
  std::vector<PluginManifest> out;
  for (const calx_descriptor* d : descriptors_) {
    PluginManifest m;
    m.id = d->id;
    m.kind = d->kind;
    m.version = d->version;
    m.license = d->license;
    m.summary = d->summary;
    m.library = m.path = path_;
    out.push_back(m);
  }
  return out;
}

calx_status PluginLibrary::create(const calx_descriptor& descriptor, const calx_config& config, calx_instance** out) {
  *out = nullptr;
  std::string key = sha256_ + descriptor.id + std::string(config.json ? config.json : "", config.json_size);
  key.append(reinterpret_cast<const char*>(config.value), config.value_count * sizeof(double));
  if (!in_child_ && is_new_configuration(key))
    try_in_child(path_, "made an instance", host_, [&] {
      calx_instance* made = nullptr;
      if (factory_->create(descriptor.id, host_.table(), &config, &made) < 0 || !made) return;
      factory_->get_interface(made, descriptor.kind);
      factory_->destroy(made);
    });
  const calx_status status =
      guarded(path_, "create", [&] { return factory_->create(descriptor.id, host_.table(), &config, out); });
  if (status >= 0 && !*out) throw Refused{path_ + ": create reported success but made no instance"};
  return status;
}

PluginInstance::PluginInstance(std::shared_ptr<PluginLibrary> library, calx_instance* instance,
                               const calx_descriptor* descriptor)
    : library_(std::move(library)), instance_(instance), descriptor_(descriptor) {}

PluginInstance::~PluginInstance() { library_->factory().destroy(instance_); }

const void* PluginInstance::table(const char* interface_id) const {
  return library_->factory().get_interface(instance_, interface_id);
}

const calx_host* PluginInstance::host() const { return library_->host().table(); }

std::string PluginInstance::label() const { return std::string(descriptor_->id) + " " + descriptor_->version; }

void PluginInstance::check(calx_status status, const std::string& file, const std::string& pointer,
                           const std::string& doing) const {
  if (status >= 0) return;
  const std::string message = library_->host().take_message(status);
  if (status == CALX_E_CONFIG) throw Error(Fault::settings, place(file, pointer) + label() + ": " + message);
  throw Error(Fault::plugin,
              place(file, pointer) + label() + ": " + doing + " failed with " + status_name(status) + ": " + message);
}

}  // namespace calx
