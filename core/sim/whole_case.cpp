#include "sim/whole_case.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "plugin/effects.hpp"

namespace calx {

CaseFile read_whole_case(const RunOptions& options) {
  std::error_code none;
  std::string folder;
  if (!options.simulation.safe_mode && std::filesystem::is_regular_file(options.case_path, none))
    folder = std::filesystem::canonical(options.case_path, none).parent_path().string();
  const PluginEffects effects(plugin_folders_of(options.simulation), folder);
  return whole_case(read_case(options.case_path, options.overrides, &effects));
}

CaseFile whole_case(CaseFile file) {
  const CaseSettings& c = file.settings;
  const auto need = [&](const std::string& a, const std::string& b, const std::string& who) {
    for (const auto& contact : c.contacts)
      if ((contact.between[0] == a && contact.between[1] == b) || (contact.between[0] == b && contact.between[1] == a))
        return;
    throw Error(Fault::settings, c.file + " /contacts: none is between \"" + a + "\" and \"" + b + "\", but " + who +
                                     " can meet; add {\"between\": [\"" + a + "\", \"" + b + "\"], \"law\": ...}");
  };
  for (std::size_t k = 0; k < c.sources.size(); ++k) {
    const SourceSettings& s = c.sources[k];
    const bool single = s.count == 1 || s.positions.size() == 1;
    if (!single) need(s.material, s.material, "particles of source \"" + s.name + "\"");
    for (std::size_t m = 0; m < k; ++m)
      need(c.sources[m].material, s.material,
           "particles of sources \"" + c.sources[m].name + "\" and \"" + s.name + "\"");
    for (const auto& part : c.parts)
      need(s.material, part.material, "particles of source \"" + s.name + "\" and part \"" + part.name + "\"");
  }
  return file;
}

}  // namespace calx
