// case_effects.hpp: the key "effects" of a case. Private to this module.
#pragma once
#include "config/document.hpp"
#include "config/effects.hpp"

namespace calx {

/// Applies every effect that the document names and leaves a record of each, marked "expanded", and an assumption. Does
/// nothing to entries that are marked already. Without a library a case with effects is refused. Throws
/// Error(Fault::settings) that names effect, role or parameter, and place.
void expand_effects(Document& document, const EffectLibrary* library);

}  // namespace calx
