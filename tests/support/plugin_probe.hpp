// plugin_probe.hpp: opens one plugin library of the build tree and talks to it as a host would, without the plugin
// module.
#pragma once
#include <dlfcn.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "calx/all.h"

namespace calx {

/// Values of one plugin's parameter table, presets until set.
class ProbeValues {
 public:
  explicit ProbeValues(const calx_descriptor& d) : descriptor_(&d) {
    for (std::uint32_t k = 0; k < d.parameter_count; ++k) values.push_back(d.parameter[k].preset);
  }
  ProbeValues& set(const std::string& name, double value) {
    values[row(name)] = value;
    return *this;
  }
  ProbeValues& set(const std::string& name, const Vec3& v) {
    return set(name + "_x", v.x).set(name + "_y", v.y).set(name + "_z", v.z);
  }
  ProbeValues& set(const std::string& name, const char* choice) {
    const std::string names = std::string("|") + descriptor_->parameter[row(name)].unit + "|";
    const std::size_t at = names.find("|" + std::string(choice) + "|");
    if (at == std::string::npos) throw std::runtime_error(name + " has no choice " + choice);
    double index = 0;
    for (std::size_t k = 0; k < at; ++k) index += names[k] == '|';
    return set(name, index);
  }
  double get(const std::string& name) const { return values[row(name)]; }
  std::vector<double> values;

 private:
  std::size_t row(const std::string& name) const {
    for (std::uint32_t k = 0; k < descriptor_->parameter_count; ++k)
      if (name == descriptor_->parameter[k].name) return k;
    throw std::runtime_error(std::string(descriptor_->id) + " has no parameter " + name);
  }
  const calx_descriptor* descriptor_;
};

/// One created instance; destroyed with the last owner.
class ProbeInstance {
 public:
  ProbeInstance(const calx_factory* factory, calx_instance* instance) : factory_(factory), instance_(instance) {}
  ~ProbeInstance() { factory_->destroy(instance_); }
  ProbeInstance(const ProbeInstance&) = delete;
  ProbeInstance& operator=(const ProbeInstance&) = delete;
  calx_instance* get() const { return instance_; }
  template <class Table>
  const Table& table(const char* id) const {
    const void* t = factory_->get_interface(instance_, id);
    if (!t) throw std::runtime_error(std::string("no table ") + id);
    return *static_cast<const Table*>(t);
  }

 private:
  const calx_factory* factory_;
  calx_instance* instance_;
};

class PluginProbe {
 public:
  /// library: the file's name in the plugin folder without its ending. Libraries stay loaded until the program ends.
  explicit PluginProbe(const std::string& library) {
    const std::string path = std::string(CALX_PLUGIN_DIR) + "/" + library + ".so";
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) throw std::runtime_error(dlerror());
    entry_ = static_cast<const calx_entry*>(dlsym(handle, "calx_plugin_entry"));
    if (!entry_ || entry_->magic != CALX_ABI_MAGIC) throw std::runtime_error(path + " is no plugin");
    host_.struct_size = sizeof host_;
    host_.abi_major = CALX_ABI_MAJOR;
    host_.abi_minor = CALX_ABI_MINOR;
    host_.self = this;
    host_.name = "probe";
    host_.version = "1.0.0";
    host_.get_extension = &no_extension;
    host_.fail = &fail;
    if (entry_->init(&host_, CALX_PLUGIN_DIR) < 0) throw std::runtime_error(path + ": init failed");
    factory_ = static_cast<const calx_factory*>(entry_->get_factory(CALX_FACTORY));
  }
  PluginProbe(const PluginProbe&) = delete;
  PluginProbe& operator=(const PluginProbe&) = delete;

  const calx_descriptor& descriptor(const std::string& id) const {
    for (std::uint32_t k = 0; k < factory_->count(); ++k)
      if (id == factory_->descriptor(k)->id) return *factory_->descriptor(k);
    throw std::runtime_error("the library holds no " + id);
  }
  ProbeValues presets(const std::string& id) const { return ProbeValues(descriptor(id)); }

  /// Throws std::runtime_error with the plugin's message when it refuses.
  std::unique_ptr<ProbeInstance> create(const std::string& id, const ProbeValues& values,
                                        const std::string& json = "{}") {
    calx_config config{};
    config.struct_size = sizeof config;
    config.value_count = static_cast<std::uint32_t>(values.values.size());
    config.value = values.values.data();
    config.json = json.c_str();
    config.json_size = json.size();
    calx_instance* instance = nullptr;
    message_.clear();
    status_ = factory_->create(id.c_str(), &host_, &config, &instance);
    if (status_ < 0) throw std::runtime_error(message_);
    return std::unique_ptr<ProbeInstance>(new ProbeInstance(factory_, instance));
  }
  /// What the last create() returned.
  calx_status status() const { return status_; }
  const calx_host* host() const { return &host_; }

 private:
  static const void* CALX_CALL no_extension(const calx_host*, const char*) { return nullptr; }
  static calx_status CALX_CALL fail(const calx_host* host, calx_status code, const char* message) {
    static_cast<PluginProbe*>(host->self)->message_ = message ? message : "";
    return code;
  }
  calx_host host_{};
  const calx_entry* entry_ = nullptr;
  const calx_factory* factory_ = nullptr;
  std::string message_;
  calx_status status_ = CALX_OK;
};

}  // namespace calx
