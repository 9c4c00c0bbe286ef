// on_device_text.hpp: the texts of the two modules that steps on a device run.
#pragma once
#include "compute/force_text.hpp"
#include "compute/law_text.hpp"

namespace calx {

/// Contacts, sums, integration, guards and ledgers with the laws and forces of a case. [any]
ModuleText step_text(const LawProgram& laws, const ForceProgram& forces, bool mixed, bool fast);
/// Building lists; the same for every case. [any]
ModuleText list_text();

}  // namespace calx
