#include "study/resolve.hpp"

#include <filesystem>
#include <map>
#include <set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/version.hpp"
#include "config/document.hpp"
#include "plugin/effects.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

/// Hashes of every file that a text of the case names: meshes, tables, positions.
void add_files(Sha256& hash, const Json& value, const std::string& folder) {
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    std::error_code ignored;
    const fs::path path = fs::path(folder) / text;
    if (!text.empty() && text.size() < 4096 && fs::is_regular_file(path, ignored)) {
      const std::string digest = sha256_file(path.string());
      hash.add(digest.data(), digest.size());
    }
    return;
  }
  if (value.is_structured())
    for (const auto& item : value) add_files(hash, item, folder);
}

std::set<std::string> plugin_ids(const CaseSettings& c) {
  std::set<std::string> out;
  for (const auto& contact : c.contacts)
    for (const auto& law : contact.laws) out.insert(law.law);
  for (const auto& part : c.parts) out.insert(part.geometry);
  for (const auto& motion : c.motions) out.insert(motion.plugin);
  for (const auto& force : c.forces) out.insert(force.plugin);
  for (const auto& sensor : c.sensors) {
    out.insert(sensor.kind);
    for (const auto& instrument : sensor.instruments) out.insert(instrument.plugin);
  }
  return out;
}

}  // namespace

CaseFile resolve(const RunRequest& request, const std::vector<std::string>& plugin_path) {
  Document document(read_text_file(request.case_path), request.case_path, {});
  Json root = document.root();
  for (std::size_t k = 0; k < request.patches.size(); ++k)
    root.merge_patch(parse_json(request.patches[k], request.case_path + " patch " + std::to_string(k + 1)));
  auto overrides = request.overrides;
  overrides.emplace_back("/seed", std::to_string(request.seed));
  // Studies look at sensors only; frames and checkpoints of a hundred runs would fill a disk.
  overrides.emplace_back("/output", R"({"frames_every": 0, "checkpoint_every_wall": 0})");
  const PluginEffects effects(plugin_search_path(plugin_path));
  return parse_case(root.dump(), request.case_path, overrides, &effects);
}

std::string cache_key(const CaseFile& file, const std::vector<std::string>& plugin_path) {
  // The place of the case is left out: what it names there is hashed by content.
  Json root = Json::parse(file.resolved);
  root.erase("relative_to");
  Sha256 hash;
  const auto add = [&](const std::string& text) {
    hash.add(text.data(), text.size());
    hash.add("\0", 1);
  };
  add(root.dump());
  add(std::to_string(file.settings.seed));
  add(std::string(version()) + " " + git_revision());
  add_files(hash, root, file.settings.folder);
  static std::map<std::string, std::string> known;  // library or law text -> hash, read once a process
  const std::set<std::string> ids = plugin_ids(file.settings);
  for (const PluginManifest& m : discover_plugins(plugin_search_path(plugin_path))) {
    if (!m.refused.empty() || ids.count(m.id) == 0) continue;
    const std::string& code = m.library.empty() ? m.text : m.library;
    std::string& digest = known[code];
    if (digest.empty()) digest = sha256_file(code);
    add(m.id + " " + digest);
  }
  return hash.finish();
}

}  // namespace calx
