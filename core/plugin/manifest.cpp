#include "plugin/manifest.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "plugin/effects.hpp"
#include "plugin/host.hpp"
#include "plugin/refused.hpp"
#include "plugin/tables.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::vector<std::string> manifest_keys = {"calx_plugin", "library", "abi",      "version", "vendor",
                                                "license",     "plugins", "requires", "sha256"};
const std::vector<std::string> plugin_keys = {"id",        "kind",    "summary", "effect",  "text",    "symbol",
                                              "stiffness", "modulus", "reach",   "example", "surface", "normal"};

/// "linux-x86_64": the key of this machine's library where a manifest names several.
std::string platform() {
  utsname system{};
  if (uname(&system) != 0) return "unknown";
  std::string name = system.sysname;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return name + "-" + system.machine;
}

const json& member(const json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) throw Refused{where + (where.empty() ? "" : " ") + "has no \"" + key + "\""};
  return *found;
}

std::string text(const json& object, const char* key, const std::string& where) {
  const json& value = member(object, key, where);
  if (!value.is_string() || value.get_ref<const std::string&>().empty())
    throw Refused{where + "/" + key + ": " + value.dump() + " is not a text"};
  return value.get<std::string>();
}

int number(const json& object, const char* key, const std::string& where) {
  const json& value = member(object, key, where);
  if (!value.is_number_integer() || value < 0 || value > 65535)
    throw Refused{where + "/" + key + ": " + value.dump() + " is not a whole number from 0 to 65535"};
  return value.get<int>();
}

void check_keys(const json& object, const std::vector<std::string>& known, const std::string& where) {
  for (const auto& item : object.items()) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    const std::string near = nearest_name(item.key(), known);
    throw Refused{where + "/" + item.key() + ": unknown key" +
                  (near.empty() ? "" : "; did you mean \"" + near + "\"?")};
  }
}

std::shared_ptr<const EffectInfo> read_effect(const json& object, const PluginManifest& of, const std::string& where) {
  try {
    auto effect = std::make_shared<EffectInfo>(parse_effect(object.dump(), where));
    effect->id = of.id;
    effect->version = of.version;
    effect->kind = of.kind;
    effect->summary = of.summary;
    effect->manifest = of.path;
    return effect;
  } catch (const Error& e) {
    throw Refused{e.what()};
  }
}

/// [A-Za-z0-9.-], with a dot, as in "calx.epam" and "org.example.wet-hertz": safe in file names, JSON and HDF5 paths.
bool is_id(const std::string& id) {
  return id.find('.') != std::string::npos && id.front() != '.' && id.back() != '.' && id.size() <= 128 &&
         id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_") == std::string::npos;
}

bool is_sha256(const std::string& hash) {
  return hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// What concerns every id of the manifest: which ABI, which host extensions.
std::string host_fault(const json& root) {
  const json& abi = member(root, "abi", "");
  if (!abi.is_object()) throw Refused{"/abi: " + abi.dump() + " is not an object"};
  const int major = number(abi, "major", "/abi"), minor = number(abi, "minor", "/abi");
  if (major != CALX_ABI_MAJOR)
    return "built for ABI " + std::to_string(major) + "." + std::to_string(minor) + ", this host speaks ABI " +
           abi_version() + ": rebuild it";
  const int draft = abi.contains("draft") ? number(abi, "draft", "/abi") : CALX_ABI_DRAFT;
  if (draft != CALX_ABI_DRAFT)
    return "built against draft " + std::to_string(draft) + " of the interface, this host speaks the released ABI " +
           abi_version() + ": rebuild it, and take \"draft\" out of the manifest";
  const auto wanted = root.find("requires");
  if (wanted == root.end()) return "";
  if (!wanted->is_array()) throw Refused{"/requires: " + wanted->dump() + " is not a list"};
  for (const json& extension : *wanted) {
    if (!extension.is_string()) throw Refused{"/requires: " + extension.dump() + " is not a text"};
    const auto& offered = host_extensions();
    if (std::find(offered.begin(), offered.end(), extension.get<std::string>()) == offered.end())
      return "needs the host extension " + extension.get<std::string>() + ", which this host lacks; it has " +
             quoted_list(offered);
  }
  return "";
}

/// Absolute path of a file beside the manifest; refuses one that leads out of its folder.
std::string path_beside(const std::string& name, const std::string& where, const fs::path& folder) {
  const fs::path wanted = (folder / name).lexically_normal();
  std::error_code bad;
  const fs::path parent = fs::canonical(wanted.parent_path(), bad);
  const auto meet = std::mismatch(folder.begin(), folder.end(), parent.begin(), parent.end());
  const bool inside = !bad && meet.first == folder.end();
  if (!inside || !wanted.has_filename()) throw Refused{where + ": \"" + name + "\" lies outside the manifest's folder"};
  const fs::path file = parent / wanted.filename();
  if (!fs::exists(fs::symlink_status(file, bad))) throw Refused{where + ": " + file.string() + " does not exist"};
  return file.string();
}

std::string library_path(const json& root, const fs::path& folder) {
  const json& value = member(root, "library", "");
  std::string name;
  if (value.is_object()) {
    const auto found = value.find(platform());
    if (found == value.end()) {
      std::vector<std::string> offered;
      for (const auto& item : value.items()) offered.push_back(item.key());
      throw Refused{"/library: holds no library for " + platform() + "; it has " + quoted_list(offered)};
    }
    name = text(value, platform().c_str(), "/library");
  } else {
    name = text(root, "library", "");
  }
  return path_beside(name, "/library", folder);
}

std::vector<std::string> names(const json& object, const char* key, const std::string& where) {
  std::vector<std::string> out;
  const auto found = object.find(key);
  if (found == object.end()) return out;
  if (!found->is_array()) throw Refused{where + "/" + key + ": " + found->dump() + " is not a list of names"};
  for (const json& one : *found) {
    if (!one.is_string()) throw Refused{where + "/" + key + ": " + one.dump() + " is not a name"};
    out.push_back(one.get<std::string>());
  }
  return out;
}

/// Names of columns of a pair row.
std::vector<std::string> columns(const json& plugin, const char* key, const std::string& where) {
  std::vector<std::string> out = names(plugin, key, where);
  for (const std::string& column : out)
    if (column.empty() || column.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
      throw Refused{where + "/" + key + ": \"" + column + "\" is not the name of a column"};
  return out;
}

/// A plugin that is a law text: no library, nothing runs before the host has read and compiled the text.
void read_text_plugin(const json& plugin, const std::string& where, PluginManifest& one) {
  const std::string name = text(plugin, "text", where);
  if (one.kind != CALX_CONTACT_LAW && one.kind != CALX_PARTICLE_FORCE)
    throw Refused{where + "/text: a plugin of the kind " + one.kind + " needs a library; a text can be a " +
                  CALX_CONTACT_LAW + " or a " + CALX_PARTICLE_FORCE};
  static const std::string ending = ".law.h";
  if (name.size() <= ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
    throw Refused{where + "/text: \"" + name + "\" does not end in .law.h"};
  const std::string stem = fs::path(name.substr(0, name.size() - ending.size())).filename().string();
  one.symbol = plugin.count("symbol") ? text(plugin, "symbol", where) : stem;
  if (one.symbol.compare(0, stem.size(), stem) != 0 ||
      one.symbol.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    throw Refused{where + "/symbol: \"" + one.symbol + "\" is not a name of lower-case letters that begins with \"" +
                  stem + "\", the stem of the text's file"};
  one.stiffness = columns(plugin, "stiffness", where);
  one.modulus = columns(plugin, "modulus", where);
  one.reach = columns(plugin, "reach", where);
  one.text = path_beside(name, where + "/text", fs::path(one.path).parent_path());
}

/// Whether key holds the second of two words; the first is the preset.
bool second_word(const json& plugin, const char* key, const std::string& first, const std::string& second,
                 const std::string& where) {
  if (!plugin.count(key)) return false;
  const std::string word = text(plugin, key, where);
  if (word != first && word != second)
    throw Refused{where + "/" + key + ": \"" + word + "\" is neither \"" + second + "\" nor \"" + first + "\""};
  return word == second;
}

/// What only `calx plugin check` reads.
void read_hints(const json& plugin, const std::string& where, PluginManifest& one) {
  const auto example = plugin.find("example");
  if (example != plugin.end()) {
    for (const json& each : example->is_array() ? *example : json::array({*example})) {
      if (!each.is_object())
        throw Refused{where + "/example: " + each.dump() + " is not an object of parameters, nor a list of such"};
      one.examples.push_back(each.dump());
    }
  }
  one.open = second_word(plugin, "surface", "closed", "open", where);
  one.pulls = second_word(plugin, "normal", "pushes", "pulls", where);
}

json parse(const std::string& path) {
  std::error_code bad;
  const auto size = fs::file_size(path, bad);
  if (bad || size > 1 << 20) throw Refused{bad ? "cannot be read: " + bad.message() : "is larger than 1 MiB"};
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw Refused{"cannot be read"};
  try {
    json root = json::parse(content.str());
    if (!root.is_object()) throw Refused{"is not a JSON object"};
    return root;
  } catch (const json::parse_error& e) {
    throw Refused{"is not JSON: error at byte " + std::to_string(e.byte)};
  }
}

}  // namespace

std::vector<PluginManifest> read_manifest(const std::string& path) {
  PluginManifest common;
  common.path = path;
  std::vector<PluginManifest> out;
  try {
    const json root = parse(path);
    const int schema = number(root, "calx_plugin", "");
    if (schema != 1)
      throw Refused{"/calx_plugin: manifest of schema " + std::to_string(schema) + ", this host reads schema 1"};
    const std::string fault = host_fault(root);
    // A newer minor may bring keys that an older host need not know.
    const bool newer = root["abi"]["minor"] > CALX_ABI_MINOR;
    if (!newer) check_keys(root, manifest_keys, "");
    common.version = text(root, "version", "");
    common.license = text(root, "license", "");
    common.vendor = root.count("vendor") ? text(root, "vendor", "") : "";
    if (root.count("sha256")) {
      common.sha256 = text(root, "sha256", "");
      if (!is_sha256(common.sha256)) throw Refused{"/sha256: not 64 lower-case hexadecimal digits"};
    }
    const json& plugins = member(root, "plugins", "");
    if (!plugins.is_array() || plugins.empty()) throw Refused{"/plugins: not a list of at least one plugin"};
    common.refused = fault;
    bool all_edits = true;  // effects of edits alone need no library
    for (std::size_t k = 0; k < plugins.size(); ++k) {
      const std::string where = "/plugins/" + std::to_string(k);
      if (!plugins[k].is_object()) throw Refused{where + ": not an object"};
      if (!newer) check_keys(plugins[k], plugin_keys, where);
      PluginManifest one = common;
      one.id = text(plugins[k], "id", where);
      one.kind = text(plugins[k], "kind", where);
      one.summary = text(plugins[k], "summary", where);
      if (!is_id(one.id))
        throw Refused{where + "/id: \"" + one.id + "\" is not an id such as \"org.example.wet-hertz\""};
      for (const PluginManifest& other : out)
        if (other.id == one.id) throw Refused{where + "/id: \"" + one.id + "\" stands twice in this manifest"};
      if (plugins[k].count("effect")) one.effect = read_effect(plugins[k]["effect"], one, where + "/effect");
      if (one.kind == kCaseEffect && !one.effect)
        throw Refused{where + "/effect: is missing; the kind " + kCaseEffect + " is nothing else"};
      if (one.kind != kCaseEffect) all_edits = false;
      const auto& kinds = known_kinds();
      if (one.refused.empty() && one.kind != kCaseEffect &&
          std::find(kinds.begin(), kinds.end(), one.kind) == kinds.end())
        one.refused = "of the kind " + one.kind + ", which this host does not know; it knows " + quoted_list(kinds);
      read_hints(plugins[k], where, one);
      out.push_back(std::move(one));
    }
    // Last, so that a case naming an id is told that its library is missing, not that the id is unknown.
    std::size_t texts = 0;
    for (std::size_t k = 0; k < plugins.size(); ++k)
      if (plugins[k].count("text")) {
        read_text_plugin(plugins[k], "/plugins/" + std::to_string(k), out[k]);
        ++texts;
      }
    if (texts > 0 && (root.count("library") || texts < plugins.size()))
      throw Refused{"/library: a manifest names either a library or a text for each of its plugins, not both"};
    if (fault.empty() && texts == 0 && !(all_edits && !root.count("library"))) {
      const std::string library = library_path(root, fs::path(path).parent_path());
      for (PluginManifest& one : out) one.library = library;
    }
  } catch (const Refused& refused) {
    const bool named = !refused.reason.empty() && refused.reason.front() == '/';
    // Keep the ids already read, so that a case naming one is told what is wrong with its manifest.
    if (out.empty()) out.push_back(common);
    for (PluginManifest& one : out) one.refused = "bad manifest " + path + (named ? " " : ": ") + refused.reason;
  }
  return out;
}

}  // namespace calx
