// sample_effect.hpp: an effect's manifest object and a small case, for tests that need no plugin.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/effects.hpp"

namespace calx {

inline const char* sample_effect() {
  return R"({
  "parameters": [
    {"name": "gap", "unit": "m", "off": 0, "scale": 0.001, "sign": "positive", "range": [0, 0.01], "doc": "width of the gap"},
    {"name": "turn_deg", "unit": "deg", "preset": 0, "range": [-360, 360], "doc": "where it is"}],
  "roles": [
    {"name": "rotor", "kind": "part", "plugins": ["org.example.rotor"], "doc": "the rotor"},
    {"name": "powder", "kind": "material", "used_by": "sources", "doc": "material of the grains"},
    {"name": "wall", "kind": "material", "used_by": "parts", "doc": "material of the walls"}],
  "touches": ["mass-per-cycle"],
  "rivals": [{"effect": "calx.load-cell-gain", "separate": "dead weights"}],
  "edits": [
    {"op": "add", "at": "/parts/{rotor}/parameters/radius", "value": "{gap}", "times": -2, "unit": "m"},
    {"op": "add", "at": "/parts/{rotor}/parameters/angle", "value": "{turn_deg}", "unit": "deg"},
    {"op": "append", "to": "/contacts/{powder}|{wall}/laws", "value": {"law": "org.example.term", "parameters": {"k": "{gap}"}}},
    {"op": "append", "to": "/forces", "unless_off": true,
     "value": {"plugin": "org.example.force", "parameters": {"min": {"$bounds": "inlet", "corner": "min"}}}},
    {"op": "scale", "at": "/shapes/grain", "value": "{gap}", "times": -100},
    {"op": "carry", "part": "{rotor}", "motion": "shift of {rotor}"},
    {"op": "set", "at": "/motions/shift of {rotor}", "value": {"plugin": "org.example.shift"}}]
})";
}

/// A library of one effect, "org.example.leak", and one preset: org.example.rotor's radius.
class SampleLibrary : public EffectLibrary {
 public:
  explicit SampleLibrary(const std::string& object = sample_effect()) {
    EffectInfo e = parse_effect(object, "/plugins/0/effect");
    e.id = "org.example.leak";
    e.version = "1.0.0";
    effects_.push_back(e);
  }
  std::vector<EffectInfo> effects() const override { return effects_; }
  std::optional<double> preset(const std::string& plugin, const std::string& row) const override {
    if (plugin == "org.example.rotor" && row == "radius") return 0.025;
    return std::nullopt;
  }

 private:
  std::vector<EffectInfo> effects_;
};

/// A case with what the effect acts on; `effects` is the value of that key, `rotor` further keys of the rotor.
inline std::string sample_case(const std::string& effects,
                               const std::string& rotor = R"("parameters": {"angle_deg": 90})",
                               const std::string& more = "") {
  return R"({"calx": 1, "domain": {"min": [-1, -1, -1], "max": [1, 1, 1]}, "time": {"end": 1},
  "materials": {"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}, "steel": {"young": 1e9, "poisson": 0.3}},
  "contacts": [{"between": ["sand", "sand"], "law": "calx.linear"},
               {"between": ["steel", "sand"], "law": "calx.linear", "parameters": {"kn": 1000}}],
  "shapes": {"grain": {"spheres": [{"at": [0, 0, 0.001], "radius": {"value": 2, "unit": "mm"}}]}},
  "regions": {"inlet": {"cylinder": {"from": [0, 0, 0.1], "to": [0, 0, 0.3], "radius": 0.05}}},
  "sources": [{"name": "fill", "shape": "grain", "material": "sand", "count": 3, "region": "inlet"}],
  "motions": {"turn": {"plugin": "org.example.turn"}},
  "parts": [{"name": "rotor", "geometry": "org.example.rotor", "material": "steel", "motion": "turn", )" +
         rotor + "}]" + more + R"(, "effects": )" + effects + "}";
}

}  // namespace calx
