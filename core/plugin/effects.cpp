// effects.cpp: effects from manifests, what describe says of them, and instruments on a recorded series.
#include "plugin/effects.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"

namespace calx {
namespace {

using Json = nlohmann::ordered_json;

const char* sign_text(EffectParameter::Sign sign) {
  return sign == EffectParameter::Sign::positive   ? ", above off only"
         : sign == EffectParameter::Sign::negative ? ", below off only"
                                                   : "";
}

/// One recorded figure through one instrument.
class Player {
 public:
  Player(PluginRegistry& registry, const InstrumentUse& use)
      : instance_(registry.create(use.plugin, CALX_SENSOR, Parameters{use.parameters, "", ""}, "recorded series")),
        table_(static_cast<const calx_sensor*>(instance_->table(CALX_SENSOR))) {
    if (table_->output_count != 1)
      throw Error(Fault::plugin, instance_->label() + " gives " + std::to_string(table_->output_count) +
                                     " numbers, so it is no instrument, which gives one");
  }
  double show(double time, double value) {
    calx_sensor_view view{};
    view.struct_size = sizeof view;
    view.time = time;
    view.input = &value;
    view.input_count = 1;
    double out = 0;
    instance_->check(table_->sample(instance_->get(), instance_->host(), &view, &out), "", "", "sample");
    return out;
  }

 private:
  InstancePtr instance_;
  const calx_sensor* table_;
};

}  // namespace

std::vector<EffectInfo> list_effects(const std::vector<std::string>& search, const std::string& text_folder) {
  std::vector<EffectInfo> out;
  std::vector<PluginManifest> found = discover_plugins(search);
  if (!text_folder.empty()) add_text_plugins(text_folder, found);
  for (const PluginManifest& m : found)
    if (m.effect && m.refused.empty()) out.push_back(*m.effect);
  std::sort(out.begin(), out.end(), [](const EffectInfo& a, const EffectInfo& b) { return a.id < b.id; });
  return out;
}

std::optional<double> PluginEffects::preset(const std::string& plugin, const std::string& row) const {
  PluginTrust trust;
  trust.text_folder = text_folder_;
  PluginRegistry registry(search_, {}, trust);
  for (const PluginManifest& m : registry.manifests()) {
    if (m.id != plugin || !m.refused.empty() || m.kind == kCaseEffect) continue;
    const calx_descriptor& d = registry.load(m.id, m.kind, "", "");
    for (std::uint32_t k = 0; k < d.parameter_count; ++k)
      if (row == d.parameter[k].name) return d.parameter[k].preset;
  }
  return std::nullopt;
}

std::string effect_text(const EffectInfo& effect) {
  std::string out = "\neffect, under \"effects\" of a case\n";
  for (const EffectParameter& p : effect.parameters)
    out += "  " + p.name + ", " + p.unit + ": " + p.doc + "; " + (p.is_amplitude ? "off " : "preset ") +
           format_number(p.off) + (p.is_amplitude ? ", typical " + format_number(p.scale) : "") + ", " +
           format_number(p.lowest) + " to " + format_number(p.highest) + sign_text(p.sign) + "\n";
  for (const EffectRole& r : effect.roles)
    out += "  on " + r.name + ": a " + r.kind + (r.plugins.empty() ? "" : " of " + quoted_list(r.plugins)) + "; " +
           r.doc + "\n";
  std::string touches;
  for (const std::string& kind : effect.touches) touches += (touches.empty() ? "" : ", ") + kind;
  out += "  touches " + touches + "\n";
  for (const EffectRival& r : effect.rivals) out += "  looks like " + r.effect + "; apart by: " + r.separate + "\n";
  if (effect.is_instrument) out += "  instrument: changes what is recorded, not what happens\n";
  return out;
}

std::vector<InstrumentUse> instruments_of(const EffectInfo& effect,
                                          const std::vector<std::pair<std::string, double>>& values) {
  if (!effect.is_instrument)
    throw Error(Fault::settings,
                "effect " + effect.id + " is no instrument; it changes what happens, so it needs a run");
  for (const auto& v : values)
    if (!effect.parameter(v.first)) {
      std::vector<std::string> known;
      for (const EffectParameter& p : effect.parameters) known.push_back(p.name);
      throw Error(Fault::settings,
                  "effect " + effect.id + " has no parameter \"" + v.first + "\"; " + did_you_mean(v.first, known));
    }
  std::vector<InstrumentUse> out;
  for (const Json& edit : Json::parse(effect.edits)) {
    if (edit["op"] != "append" || !edit["value"].count("plugin")) continue;
    Json parameters = edit["value"].value("parameters", Json::object());
    for (auto& item : parameters.items())
      for (const EffectParameter& p : effect.parameters) {
        if (item.value() != "{" + p.name + "}") continue;
        const auto given = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == p.name; });
        item.value() = given == values.end() ? p.off : given->second;
        break;
      }
    out.push_back({edit["value"]["plugin"], parameters.dump()});
  }
  return out;
}

std::vector<double> apply_instruments(PluginRegistry& registry, const std::vector<InstrumentUse>& instruments,
                                      const std::vector<double>& time, const std::vector<double>& value) {
  if (time.size() != value.size())
    throw Error(Fault::settings, "a series of " + std::to_string(time.size()) + " times and " +
                                     std::to_string(value.size()) + " values; must be one value per time");
  for (std::size_t k = 0; k < time.size(); ++k)
    if (!std::isfinite(time[k]) || (k > 0 && !(time[k] > time[k - 1])))
      throw Error(Fault::settings, "time " + format_quantity(time[k], "s") + " of row " + std::to_string(k + 1) +
                                       " of the series does not rise; must be above the one before");
  std::vector<double> out = value;
  for (const InstrumentUse& use : instruments) {
    Player player(registry, use);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = player.show(time[k], out[k]);
  }
  return out;
}

}  // namespace calx
