// discovery.cpp: where plugins are looked for, and which manifests lie there. Nothing is loaded or executed.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "base/error.hpp"
#include "plugin/manifest.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

// secure_getenv: a program with raised rights must not load what its caller's environment names.
std::string environment(const char* name) {
  const char* value = secure_getenv(name);
  return value ? value : "";
}

class FolderList {
 public:
  /// Folders that do not exist, and those that stand in the list already, are left out.
  void add(const fs::path& folder) {
    std::error_code bad;
    const fs::path real = fs::canonical(folder, bad);
    if (bad || !fs::is_directory(real, bad)) return;
    const std::string name = real.string();
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  }
  std::vector<std::string> list;
};

bool is_manifest(const fs::path& path) {
  static const std::string ending = ".plugin.json";
  const std::string name = path.filename().string();
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

std::vector<std::string> plugin_search_path(const std::vector<std::string>& given) {
  FolderList folders;
  for (const std::string& folder : given) {
    std::error_code bad;
    if (folder.empty() || !fs::is_directory(folder, bad))
      throw Error(Fault::files,
                  "plugin folder \"" + folder + "\" does not exist; give a folder that holds *.plugin.json");
    folders.add(folder);
  }

  const std::string listed = environment("CALX_PLUGIN_PATH");
  for (std::size_t from = 0; from <= listed.size();) {
    const std::size_t to = std::min(listed.find(':', from), listed.size());
    const std::string folder = listed.substr(from, to - from);
    from = to + 1;
    if (folder.empty()) continue;  // a shell would read it as the working directory
    if (!fs::path(folder).is_absolute())
      throw Error(Fault::files,
                  "CALX_PLUGIN_PATH: \"" + folder +
                      "\" is not an absolute path; plugins are never looked for relative to the working directory");
    folders.add(folder);
  }

  const fs::path data = environment("XDG_DATA_HOME");
  const fs::path home = environment("HOME");
  if (data.is_absolute())
    folders.add(data / "calx" / "plugins");
  else if (home.is_absolute())
    folders.add(home / ".local" / "share" / "calx" / "plugins");

  for (const std::string& folder : installed_plugin_folders()) folders.add(folder);
  return folders.list;
}

std::string program_prefix() {
  std::error_code bad;
  return fs::read_symlink("/proc/self/exe", bad).parent_path().parent_path().string();
}

std::vector<std::string> installed_plugin_folders() {
  FolderList folders;
  const fs::path prefix = program_prefix();
  if (!prefix.empty()) {
    folders.add(prefix / "plugins");
    folders.add(prefix / "lib" / "calx" / "plugins");
  }
  return folders.list;
}

namespace {

/// Paths of the manifests in a folder, sorted.
std::vector<std::string> manifests_in(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code bad;
  for (fs::directory_iterator at(folder, bad), end; !bad && at != end; at.increment(bad))
    if (is_manifest(at->path())) out.push_back(at->path().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// Adds one manifest's plugin; of an id that is provided already the first wins.
void add(PluginManifest one, std::map<std::string, std::string>& first, std::vector<PluginManifest>& found) {
  if (one.refused.empty()) {
    const auto added = first.emplace(one.id, one.path);
    if (!added.second)
      one.refused =
          "id " + one.id + " is provided by " + added.first->second + " already, so " + one.path + " is not used";
  }
  found.push_back(std::move(one));
}

}  // namespace

std::vector<PluginManifest> discover_plugins(const std::vector<std::string>& path) {
  FolderList folders;
  for (const std::string& folder : path)
    if (!folder.empty()) folders.add(folder);

  std::vector<PluginManifest> found;
  std::map<std::string, std::string> first;  // usable id to the manifest that provides it
  for (const std::string& folder : folders.list)
    for (const std::string& manifest : manifests_in(folder))
      for (PluginManifest& one : read_manifest(manifest)) add(std::move(one), first, found);
  return found;
}

void add_text_plugins(const std::string& folder, std::vector<PluginManifest>& found) {
  FolderList folders;
  folders.add(folder);
  std::map<std::string, std::string> first;
  for (const PluginManifest& one : found)
    if (one.refused.empty()) first.emplace(one.id, one.path);
  for (const std::string& real : folders.list)
    for (const std::string& manifest : manifests_in(real)) {
      // A folder of the search path may be that of the case, too.
      if (std::any_of(found.begin(), found.end(), [&](const PluginManifest& one) { return one.path == manifest; }))
        continue;
      for (PluginManifest& one : read_manifest(manifest))
        if (!one.text.empty()) add(std::move(one), first, found);
    }
}

}  // namespace calx
