// new_plugin.cpp: a project from the templates of abi/template, which are plugins themselves, called my-plugin.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/text.hpp"
#include "conformance/conformance.hpp"
#include "plugin/plugin.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;

/// wet-hertz -> wet_hertz and WetHertz.
std::string symbol_of(const std::string& name) { return replaced(name, "-", "_"); }
std::string class_of(const std::string& name) {
  std::string out;
  bool upper = true;
  for (const char c : name) {
    if (c != '-') out += upper && c >= 'a' ? static_cast<char>(c - 32) : c;
    upper = c == '-';
  }
  return out;
}

std::string renamed(const std::string& text, const std::string& name) {
  return replaced(replaced(replaced(text, "my_plugin", symbol_of(name)), "MyPlugin", class_of(name)), "my-plugin",
                  name);
}

/// In an installation and in a build tree the templates lie at the same place beside the program.
fs::path template_folder(const std::string& kind) {
  std::error_code bad;
  const fs::path folder = fs::path(program_prefix()) / "share" / "calx" / "template" / kind;
  if (!fs::is_directory(folder, bad))
    throw Error(Fault::files, folder.string() +
                                  ": the templates of plugins are not there; they are installed with Calx, "
                                  "cmake --install BUILD --component abi");
  return folder;
}

constexpr const char* kTextKind = "contact-law-text";

/// Files that a project of one kind takes from the template of another: a law without native code the text and the case
/// of one that has it, others what builds them.
std::pair<const char*, std::vector<const char*>> shared_files(const std::string& kind) {
  if (kind == kTextKind) return {"contact-law", {"my_plugin.law.h", "try.json"}};
  if (kind == "particle-force" || kind == "effect") return {"contact-law", {"CMakeLists.txt"}};
  if (kind == "contact-law" || kind == "motion") return {};
  return {"motion", {"CMakeLists.txt"}};
}

std::vector<fs::path> template_files(const std::string& kind) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(template_folder(kind))) files.push_back(entry.path());
  const auto [owner, shared] = shared_files(kind);
  for (const char* file : shared) files.push_back(template_folder(owner) / file);
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return a.filename() < b.filename(); });
  return files;
}

void check_name(const std::string& name) {
  const bool letters = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
  const bool begins = !name.empty() && name.front() >= 'a' && name.front() <= 'z' && name.back() != '-';
  if (letters && begins && name.find("--") == std::string::npos && name.size() <= 40) return;
  throw Error(Fault::usage,
              "plugin new " + name +
                  ": a name is made of lower-case letters, digits and single -, begins with a letter and has at "
                  "most 40 characters, as in wet-hertz");
}

}  // namespace

std::vector<std::string> new_plugin_kinds() {
  return {"contact-law", kTextKind, "geometry", "motion", "servo", "particle-force", "sensor", "effect"};
}

std::vector<std::string> new_plugin(const std::string& name, const std::string& kind, const std::string& folder) {
  check_name(name);
  const std::vector<std::string> kinds = new_plugin_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw Error(Fault::usage, "--kind " + kind + ": no such kind; " + did_you_mean(kind, kinds));
  std::error_code bad;
  if (!fs::is_directory(folder, bad)) throw Error(Fault::files, folder + ": no such folder");
  const fs::path project = fs::path(folder) / name;
  if (fs::exists(fs::symlink_status(project, bad)))
    throw Error(Fault::files,
                project.string() + " is there already and is left as it is; take another name, or remove it");

  const std::vector<fs::path> files = template_files(kind);
  if (!fs::create_directory(project, bad)) throw Error(Fault::files, project.string() + ": " + bad.message());
  std::vector<std::string> written;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const fs::path to = project / renamed(file.filename().string(), name);
    std::ofstream out(to, std::ios::binary);
    out << renamed(text, name);
    if (!out.flush()) throw Error(Fault::files, to.string() + " cannot be written");
    written.push_back(to.string());
  }
  return written;
}

std::string new_plugin_advice(const std::string& name, const std::string& kind, const std::string& folder) {
  const std::string enter = "  cd " + (fs::path(folder) / name).lexically_normal().string() + "\n";
  if (kind == kTextKind) return "\nnext:\n" + enter + "  calx plugin check .\n  calx run try.json\n";
  std::error_code bad;
  const bool installed = fs::exists(fs::path(program_prefix()) / "lib" / "cmake" / "CalxAbi", bad);
  return "\nnext:\n" + enter +
         "  cmake -S . -B build -DCMAKE_PREFIX_PATH=" + (installed ? program_prefix() : "<where Calx is installed>") +
         "\n  cmake --build build && ctest --test-dir build --output-on-failure\n"
         "  calx run try.json --plugin-path build/plugins\n";
}

}  // namespace calx
