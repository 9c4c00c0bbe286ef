// find.hpp: from the path an author gives to manifests. Private to core/conformance.
#pragma once
#include <string>
#include <vector>

#include "plugin/plugin.hpp"

namespace calx::conformance {

/// A list per manifest, sorted by path, of its plugins; at least one. Throws Error(Fault::files): no such path, no
/// manifest there, a library that no manifest beside it names.
std::vector<std::vector<PluginManifest>> find_manifests(const std::string& path);

/// Paths of the manifests that path means; empty where there are none. Throws Error(Fault::files) for no such path.
std::vector<std::string> manifest_paths(const std::string& path);

}  // namespace calx::conformance
