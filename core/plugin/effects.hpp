// effects.hpp: the effects among the plugins found, for cases and for the diagnosis, and instruments applied to a
// recorded series. Reading manifests runs nothing; only applying an instrument loads its library.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/effects.hpp"
#include "plugin/plugin.hpp"

namespace calx {

/// Kind of a manifest entry without a library: an effect that only changes parameters of parts and particles.
constexpr const char* kCaseEffect = "calx.case-effect/1";

/// Every usable effect in the folders, sorted by id. search: usually from plugin_search_path; text_folder: of a case,
/// where effects that are a law text may stand; empty: none. Throws nothing for a refused manifest; `calx plugin list`
/// says why it was refused.
std::vector<EffectInfo> list_effects(const std::vector<std::string>& search, const std::string& text_folder = "");

/// The library that read_case asks.
class PluginEffects : public EffectLibrary {
 public:
  explicit PluginEffects(std::vector<std::string> search, std::string text_folder = "")
      : search_(std::move(search)), text_folder_(std::move(text_folder)) {}
  std::vector<EffectInfo> effects() const override { return list_effects(search_, text_folder_); }
  std::optional<double> preset(const std::string& plugin, const std::string& row) const override;

 private:
  std::vector<std::string> search_;
  std::string text_folder_;
};

/// What "calx plugin describe" says of an effect.
std::string effect_text(const EffectInfo& effect);

/// One instrument of a sensor: plugin id and its parameters as a JSON object.
struct InstrumentUse {
  std::string plugin, parameters = "{}";
};

/// The instruments that an effect puts on a sensor, at the parameters given (values in the parameters' units; others at
/// off or preset). Throws Error(Fault::settings) for an effect that is no instrument or an unknown parameter.
std::vector<InstrumentUse> instruments_of(const EffectInfo& effect,
                                          const std::vector<std::pair<std::string, double>>& values);

/// A recorded series as the instruments would have shown it. time: s, rising; value: one per time, SI. The series is
/// the true figure at these times, so a fine one gives a fine lag. Gives one value per time. Throws
/// Error(Fault::settings) for bad parameters or times that do not rise, Error(Fault::plugin) when a plugin is not there
/// or fails. [main]
std::vector<double> apply_instruments(PluginRegistry& registry, const std::vector<InstrumentUse>& instruments,
                                      const std::vector<double>& time, const std::vector<double>& value);

}  // namespace calx
