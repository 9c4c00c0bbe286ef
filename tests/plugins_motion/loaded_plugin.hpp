// loaded_plugin.hpp: one instance of a built plugin library, made through its C entry alone.
#pragma once
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "calx/all.h"

namespace calx_test {

/// What the plugin said through host->fail.
struct PluginRefusal : std::runtime_error {
  PluginRefusal(calx_status s, const std::string& message) : std::runtime_error(message), status(s) {}
  calx_status status;
};

class LoadedPlugin {
 public:
  /// library: name in the plugin folder without ending. given: parameters that differ from their presets.
  LoadedPlugin(const std::string& library, const std::string& id, const std::map<std::string, double>& given = {},
               const std::string& json = "{}") {
    host_ = {sizeof(calx_host), CALX_ABI_MAJOR, CALX_ABI_MINOR, this, "test", "1", &no_extension, &keep_message};
    handle_ = dlopen((CALX_PLUGIN_DIR "/" + library + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle_) throw std::runtime_error(dlerror());
    entry_ = static_cast<const calx_entry*>(dlsym(handle_, "calx_plugin_entry"));
    REQUIRE(entry_ != nullptr);
    REQUIRE(entry_->magic == CALX_ABI_MAGIC);
    REQUIRE(entry_->init(&host_, CALX_PLUGIN_DIR) == CALX_OK);
    factory_ = static_cast<const calx_factory*>(entry_->get_factory(CALX_FACTORY));
    REQUIRE(factory_ != nullptr);
    REQUIRE(factory_->count() == 1);
    descriptor_ = factory_->descriptor(0);
    REQUIRE(descriptor_->id == id);

    std::vector<double> values;
    std::size_t used = 0;
    for (std::uint32_t k = 0; k < descriptor_->parameter_count; ++k) {
      const calx_field& f = descriptor_->parameter[k];
      CHECK(f.lowest <= f.preset);
      CHECK(f.preset <= f.highest);
      const auto found = given.find(f.name);
      used += found != given.end();
      values.push_back(found != given.end() ? found->second : f.preset);
    }
    REQUIRE(used == given.size());  // a misspelt name in a test
    const calx_config config = {sizeof(calx_config), descriptor_->parameter_count, values.data(), json.data(),
                                json.size()};
    const calx_status status = factory_->create(descriptor_->id, &host_, &config, &instance_);
    if (status != CALX_OK) {
      const PluginRefusal refusal(status, message_);
      close();
      throw refusal;
    }
  }
  ~LoadedPlugin() { close(); }
  LoadedPlugin(const LoadedPlugin&) = delete;
  LoadedPlugin& operator=(const LoadedPlugin&) = delete;

  calx_instance* instance() const { return instance_; }
  const calx_host* host() const { return &host_; }
  const calx_descriptor& descriptor() const { return *descriptor_; }
  const std::string& message() const { return message_; }
  template <class Table>
  const Table* table(const char* kind) const {
    CHECK(factory_->get_interface(instance_, "calx.motion/1x") == nullptr);
    const Table* t = static_cast<const Table*>(factory_->get_interface(instance_, kind));
    REQUIRE(t != nullptr);
    REQUIRE(t->struct_size == sizeof(Table));
    REQUIRE(t->draft == CALX_ABI_DRAFT);
    return t;
  }

 private:
  static const void* no_extension(const calx_host*, const char*) { return nullptr; }
  static calx_status keep_message(const calx_host* host, calx_status code, const char* text) {
    static_cast<LoadedPlugin*>(host->self)->message_ = text;
    return code;
  }
  void close() {
    if (instance_) factory_->destroy(instance_);
    instance_ = nullptr;
    entry_->deinit();
    dlclose(handle_);
  }

  calx_host host_{};
  void* handle_ = nullptr;
  const calx_entry* entry_ = nullptr;
  const calx_factory* factory_ = nullptr;
  const calx_descriptor* descriptor_ = nullptr;
  calx_instance* instance_ = nullptr;
  std::string message_;
};

/// The message with which a plugin refuses parameters; the status must be CALX_E_CONFIG.
inline std::string refusal(const std::string& library, const std::string& id,
                           const std::map<std::string, double>& given, const std::string& json = "{}") {
  try {
    LoadedPlugin plugin(library, id, given, json);
  } catch (const PluginRefusal& e) {
    CHECK(e.status == CALX_E_CONFIG);
    return e.what();
  }
  FAIL("the plugin accepted the parameters");
  return "";
}

}  // namespace calx_test
