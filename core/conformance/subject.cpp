#include "conformance/subject.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "config/config.hpp"
#include "plugin/refused.hpp"

namespace calx::conformance {
namespace {

std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> out(1);
  for (const char c : names)
    if (c == '|')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

}  // namespace

Subject::Subject(const PluginManifest& manifest, std::uint64_t seed)
    : manifest_(manifest),
      library_(std::make_shared<PluginLibrary>(manifest, "", true)),
      descriptor_(&library_->descriptor(manifest)),
      bits_(seed) {}

double Subject::uniform(double lowest, double highest) {
  return lowest + (highest - lowest) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
}

std::vector<Variant> Subject::variants() const {
  std::vector<Variant> out(1);
  const calx_descriptor& d = *descriptor_;
  out[0].name = "presets";
  for (std::uint32_t k = 0; k < d.parameter_count; ++k) out[0].values.push_back(d.parameter[k].preset);
  for (std::uint32_t k = 0; k < d.parameter_count; ++k) {
    if (!(d.parameter[k].flags & CALX_FIELD_CHOICE)) continue;
    const std::vector<std::string> names = split(d.parameter[k].unit);
    for (std::size_t choice = 0; choice < names.size(); ++choice) {
      if (static_cast<double>(choice) == d.parameter[k].preset) continue;
      Variant variant = out[0];
      variant.name = std::string(d.parameter[k].name) + " = " + names[choice];
      variant.values[k] = static_cast<double>(choice);
      out.push_back(variant);
    }
  }
  for (std::size_t k = 0; k < manifest_.examples.size(); ++k) {
    Variant variant;
    variant.name = "example " + std::to_string(k + 1) + " of the manifest";
    variant.example = manifest_.examples[k];
    out.push_back(variant);
  }
  return out;
}

InstancePtr Subject::make(const Variant& variant) {
  const calx_descriptor& d = *descriptor_;
  std::vector<double> values = variant.values;
  std::string json = variant.json;
  const std::string who = std::string(d.id) + " (" + variant.name + ")";
  if (!variant.example.empty()) {
    try {
      Parameters parameters;
      parameters.json = variant.example;
      parameters.folder = std::filesystem::path(manifest_.path).parent_path().string();
      // A law's example also holds values of its pair, which are read once its tables are known.
      std::vector<std::string> keys;
      if (manifest_.kind == CALX_CONTACT_LAW) {
        const nlohmann::json object = nlohmann::json::parse(variant.example);
        for (const auto& item : object.items()) keys.push_back(item.key());
      }
      const ResolvedParameters resolved =
          resolve_parameters(parameters, {{d.parameter, d.parameter_count}}, d.extra_schema, who, manifest_.path, keys);
      values = resolved.values.at(0);
      json = resolved.extra_json;
    } catch (const Error& e) {
      throw Failed{std::string("the example of the manifest is wrong: ") + e.what()};
    }
  }
  const calx_config config = {sizeof(calx_config), d.parameter_count, values.data(), json.c_str(), json.size()};
  calx_instance* made = nullptr;
  const calx_status status = library_->create(d, config, &made);
  if (status < 0) throw Failed{who + ": create says " + library_->host().take_message(status)};
  return std::make_shared<PluginInstance>(library_, made, &d);
}

InstancePtr Subject::any() {
  std::string why;
  for (const Variant& variant : variants()) {
    try {
      return make(variant);
    } catch (const Failed& failed) {
      if (why.empty()) why = failed.detail;
    }
  }
  throw Failed{why + "; give parameters that work as \"example\": {...} in the plugin's entry of the manifest"};
}

}  // namespace calx::conformance
