// laws.hpp: the contact laws of a case, loaded, given their parameters and laid out for the engine.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "compute/law_list.hpp"
#include "config/config.hpp"
#include "plugin/contact_law.hpp"

namespace calx {

struct CaseLaws {
  std::vector<std::unique_ptr<LawList>> lists;
  std::vector<const LawList*> matrix;  // [a * material_count + b], null where no law is given
  std::vector<std::unique_ptr<ContactLaw>> laws;
  std::vector<std::string> scaled;   // "calcine-calcine calx.epam: surface_energy 0.1 J/m^2 -> 0.2 J/m^2"
  std::vector<std::string> presets;  // "calcine-calcine calx.epam: pull_off = 0 N (preset)", for calx check
};

/// Throws Error(Fault::plugin) for a law that cannot be loaded, Error(Fault::settings) for parameters it refuses and
/// for material keys that no law knows.
CaseLaws load_laws(const CaseSettings& settings, PluginRegistry& registry);

}  // namespace calx
