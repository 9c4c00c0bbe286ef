// effects.hpp: effects that a case names under "effects": what a manifest says of one, and where the reader of a case
// finds them. An effect is a hidden cause with a strength: a plugin, or parameters of parts that are there already, put
// into a case by a list of edits. At its off value a case gives the bits it gives without the effect.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace calx {

/// A number of an effect, in `unit`. An amplitude vanishes at `off`, and it must be given; any other shapes the effect
/// and has `off` as its preset.
struct EffectParameter {
  enum class Sign { any, positive, negative };  // side of off that physics allows
  std::string name, unit, doc;
  std::string direction_of;  // an angle that turns this amplitude, 0 along its preset; empty: none
  bool is_amplitude = true;
  double off = 0, scale = 0;  // scale: a typical strength, as distance from off; 0 for what is no amplitude
  Sign sign = Sign::any;
  double lowest = 0, highest = 0;
};

/// Something in the case that the effect acts on. A user names it under "on"; a role with one candidate in the case, or
/// with one that is called like the role, may be left out.
struct EffectRole {
  std::string name, doc;
  std::string kind;                  // part, motion, material, region, sensor, source, shape or event
  std::vector<std::string> plugins;  // ids that a part, motion or sensor must have one of; none: any
  std::string used_by;               // of a material: "sources" or "parts"; empty: any
};

/// A cause that looks alike, and the measurement that tells them apart.
struct EffectRival {
  std::string effect, separate;
};

struct EffectInfo {
  std::string id, version, kind, summary;
  std::string manifest;  // path
  std::vector<EffectParameter> parameters;
  std::vector<EffectRole> roles;
  std::vector<std::string> touches;  // kinds of observables it can change
  std::vector<EffectRival> rivals;
  bool is_instrument = false;  // changes what is recorded, not what happens: can be applied to a recorded series
  std::string edits = "[]";    // JSON list; see abi/README.md, "Effects"

  const EffectParameter* parameter(const std::string& name) const;
  const EffectRole* role(const std::string& name) const;
};

/// Kinds of observables that "touches" may hold: those of a study.
const std::vector<std::string>& effect_observables();

/// What the manifest object at `where` ("/plugins/0/effect") says; id, version, kind, summary and manifest stay empty.
/// text: the JSON object. Throws Error(Fault::plugin), "<where>/parameters/0/off: ...".
EffectInfo parse_effect(const std::string& text, const std::string& where);

/// Effects that cases may name, and the presets of plugins that their edits change. Asked only for a case that names an
/// effect. core/plugin/effects.hpp has the one that reads manifests.
class EffectLibrary {
 public:
  virtual ~EffectLibrary() = default;
  virtual std::vector<EffectInfo> effects() const = 0;
  /// Preset, SI, of a row of a plugin's parameter table; nothing when the plugin or the row is not there.
  virtual std::optional<double> preset(const std::string& plugin, const std::string& row) const = 0;
};

}  // namespace calx
