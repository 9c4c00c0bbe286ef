// manifest.hpp: reads one NAME.plugin.json. For core/plugin and core/conformance.
#pragma once
#include <string>
#include <vector>

#include "plugin/plugin.hpp"

namespace calx {

/// One entry per plugin id the manifest names, with refused set where this host cannot use it; a manifest that cannot
/// be understood at all gives one entry without id. Reads the manifest only: the library is looked for, not opened.
/// path: absolute and canonical.
std::vector<PluginManifest> read_manifest(const std::string& path);

}  // namespace calx
