// effect_edits.hpp: applies the edits of one effect to a case. Private to this module.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/document.hpp"
#include "config/effects.hpp"

namespace calx {

/// One use of an effect in a case, with every role bound and every parameter filled in.
struct EffectUse {
  const EffectInfo* effect = nullptr;
  std::string pointer;                    // where the case names it
  std::map<std::string, std::string> on;  // role -> name
  std::map<std::string, double> values;   // parameter -> value, in its unit
  bool is_off() const;
};

/// Names of a kind in the case, with what the role allows first sorted out. Wrong types are left for later readers.
std::vector<std::string> role_candidates(const Json& root, const EffectRole& role);
/// All names of that kind.
std::vector<std::string> names_of_kind(const Json& root, const std::string& kind);

/// Changes the document. Throws Error(Fault::settings): "case.json /effects/0: effect ID, edit 1 (add ...): ...".
void apply_edits(Document& document, const EffectUse& use, const EffectLibrary& library);

/// Operations of edits, for the check of manifests.
struct EditShape {
  const char* op;
  std::vector<std::string> needs, may;
};
const std::vector<EditShape>& edit_shapes();

/// The names in braces of a text: "tilt of {canister}" -> canister.
std::vector<std::string> placeholders(const std::string& text);

}  // namespace calx
