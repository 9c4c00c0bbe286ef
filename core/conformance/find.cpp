#include "conformance/find.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "plugin/manifest.hpp"

namespace calx::conformance {
namespace {

namespace fs = std::filesystem;

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::vector<std::string> in_folder(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code bad;
  for (fs::directory_iterator at(folder, bad), end; !bad && at != end; at.increment(bad))
    if (ends_with(at->path().string(), ".plugin.json")) out.push_back(at->path().string());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<std::string> manifest_paths(const std::string& path) {
  std::error_code bad;
  const fs::path real = fs::canonical(path, bad);
  if (bad)
    throw Error(Fault::files,
                path + ": " + bad.message() + "; give a manifest NAME.plugin.json, its library or a folder");
  if (fs::is_directory(real)) return in_folder(real);
  if (ends_with(real.string(), ".plugin.json")) return {real.string()};
  std::vector<std::string> out;
  for (const std::string& manifest : in_folder(real.parent_path()))
    for (const PluginManifest& one : read_manifest(manifest))
      if ((one.library == real.string() || one.text == real.string()) &&
          std::find(out.begin(), out.end(), manifest) == out.end())
        out.push_back(manifest);
  return out;
}

std::vector<std::vector<PluginManifest>> find_manifests(const std::string& path) {
  std::vector<std::vector<PluginManifest>> out;
  for (const std::string& manifest : manifest_paths(path)) out.push_back(read_manifest(manifest));
  if (!out.empty()) return out;
  const bool folder = fs::is_directory(path);
  throw Error(Fault::files,
              path + (folder ? ": holds no *.plugin.json; calx_add_plugin writes library and manifest into "
                               "one folder, give that"
                             : ": no manifest *.plugin.json beside it names this file as its library"));
}

}  // namespace calx::conformance
