// doctor.cpp: why a plugin is refused, for the person who wants to use it, and what helps.
#include <filesystem>

#include "base/error.hpp"
#include "conformance/conformance.hpp"
#include "conformance/find.hpp"
#include "plugin/plugin.hpp"

namespace calx {

using namespace conformance;

namespace {

/// Words of a refusal, what they mean, and what helps.
struct Cure {
  const char* words;
  const char* meaning;
  const char* remedy;
};
const Cure kCures[] = {
    {"can be changed by every user", "Anybody on this machine could put other code into the file, so it is not run.",
     "chmod o-w on the file, after you have made sure that it is what you built."},
    {"belongs to user", "The file belongs to somebody else, who could change it at any time.",
     "Copy it into a folder of your own, or have root own it: then it is yours to answer for."},
    {"is a symbolic link", "A link may point elsewhere tomorrow; what is checked must be what is loaded.",
     "Copy the library itself beside its manifest."},
    {"lies outside the manifest's folder", "A manifest may only name a library beside or below it.",
     "Put library and manifest into one folder, and name the library without a path."},
    {"does not exist", "The manifest names a file that is not there.",
     "Build the plugin, or correct \"library\" (or \"text\") in the manifest; calx_add_plugin writes both."},
    {"is not JSON", "The manifest cannot be read.",
     "Open it at the place named; a comma or a bracket is missing or too many."},
    {"unknown key", "The manifest holds a key that this Calx does not know.",
     "Correct the spelling, or remove the key."},
    {"bad manifest", "The manifest cannot be understood.",
     "Compare it with the manifest in abi/README.md, or with that of calx plugin new."},
    {"holds no library for", "The manifest names libraries for other machines only.",
     "Build the plugin on this machine and add its library."},
    {"-ffast-math", "Loading the library changes how the whole program computes, and with it every other result.",
     "Compile without -ffast-math and -Ofast, also when linking; calx_add_plugin refuses them. Do not call "
     "fesetround."},
    {"changed the floating-point mode",
     "The plugin changes how the whole program computes, and with it every other result.",
     "Remove the call of fesetround or of _mm_setcsr, or put the mode back before returning."},
    {"rebuild it", "The plugin was compiled against another version of the headers than this Calx speaks.",
     "Compile it again against the headers of this installation: cmake -DCMAKE_PREFIX_PATH=<where Calx is installed>."},
    {"undefined symbol", "The library calls something that neither it nor the C library holds.",
     "Link what it needs into it; -Wl,-z,defs shows what is missing when it is linked. A plugin gets nothing from Calx "
     "but "
     "the host table."},
    {"cannot open shared object file", "The library needs another library that is not there.",
     "Link that library statically into the plugin (-l:libNAME.a), or install it."},
    {"invalid ELF header", "The file is no shared library of this system.",
     "Build it with calx_add_plugin on this machine."},
    {"exports no calx_plugin_entry", "The library is no Calx plugin, or hides its one symbol.",
     "Define calx_plugin_entry with CALX_EXPORT, in C++ inside of extern \"C\"; CALX_PLUGIN(Class) does it."},
    {"it is no Calx plugin", "What the library exports is not the entry of a Calx plugin.",
     "Begin calx_plugin_entry with CALX_ABI_MAGIC; CALX_PLUGIN(Class) does it."},
    {"has SHA-256", "The file is not the one that was pinned or noted in the manifest.",
     "If you built it anew, correct the hash; if you did not, do not use the file."},
    {"does not pin it", "The run asked for pinned plugins only (--require-pins).",
     "Add the line shown to the case, if you trust the file."},
    {"is provided by", "Two manifests hold the same id, and the first one found is used.",
     "Remove one of them, or put the folder of the one you want first with --plugin-path."},
    {"holds no plugin", "Manifest and library do not fit together.", "Build again, so that both come from one source."},
    {"although", "Manifest and library do not fit together.", "Build again, so that both come from one source."},
    {"manifest says", "Manifest and library tell different things.",
     "Make id, kind, version and hash the same in both."},
    {"needs the host extension", "The plugin needs an ability that this Calx does not have.",
     "Use a newer Calx, or a version of the plugin that does without."},
    {"which this host does not know", "The plugin is of a kind that this Calx does not know.", "Use a newer Calx."},
    {"crashed with", "The plugin crashed; a child process took the blow.",
     "Debug it: gdb --args calx plugin check PATH --only loads --in-process."},
    {"ended the process", "The plugin called exit or abort, which would have ended your run.",
     "Return a negative status through host->fail instead; in C++ let calx::guard turn exceptions into one."},
    {"did not come back", "The plugin never returned from this call.",
     "Look for an endless loop or for waiting on input, a network or a lock in init and create."},
    {"breaks the dialect", "The law's text uses something that not every device has.",
     "Change the lines named; abi/README.md lists what a law may use."},
    {"does not compile", "The law's text does not compile.", "Correct the line that the compiler names."},
    {"needs a C++ compiler", "A plugin that is a law text is compiled on this machine, which has no compiler.",
     "sudo apt install g++, or set CALX_CXX."},
    {"failed with", "The plugin itself reports an error.", "Its own words above say what it misses."},
    {"its table", "A table of functions or fields that the plugin hands over is wrong.",
     "calx plugin check PATH names the row or function."},
};

std::string explained(const std::string& reason) {
  std::string out = "  refused: " + reason + "\n";
  for (const Cure& cure : kCures)
    if (reason.find(cure.words) != std::string::npos)
      return out + "  meaning: " + cure.meaning + "\n  remedy:  " + cure.remedy + "\n";
  return out + "  remedy:  calx plugin check PATH shows more.\n";
}

/// Loads the plugin as a run would, and makes an instance of presets.
std::string refusal_of(const PluginManifest& manifest) {
  PluginRegistry registry({std::filesystem::path(manifest.path).parent_path().string()});
  try {
    for (const PluginManifest& one : registry.manifests())
      if (one.id == manifest.id && one.path == manifest.path && !one.refused.empty()) return one.refused;
    const calx_descriptor& d = registry.load(manifest.id, manifest.kind, "", "");
    std::vector<double> presets;
    for (std::uint32_t k = 0; k < d.parameter_count; ++k) presets.push_back(d.parameter[k].preset);
    registry.create_with_values(manifest.id, manifest.kind, "", "", presets);
  } catch (const Error& e) {
    // A plugin that misses what the user must give is well.
    const std::string start = "plugin " + manifest.id + " refused: ", said = e.what();
    if (e.fault() == Fault::plugin) return said.rfind(start, 0) == 0 ? said.substr(start.size()) : said;
  }
  return "";
}

std::string without_manifest(const std::string& path) {
  namespace fs = std::filesystem;
  const std::string about = fs::is_directory(path) ? "  There is no *.plugin.json in this folder.\n"
                                                   : "  No manifest *.plugin.json beside it names this file.\n";
  return path + "\n" + about +
         "  meaning: Calx finds plugins by their manifests and loads nothing else, so that no code runs because it "
         "lies in a "
         "folder.\n"
         "  remedy:  build with calx_add_plugin(... MANIFEST NAME.plugin.json.in), which writes both side by side; or "
         "begin "
         "anew with calx plugin new NAME --kind KIND.\n";
}

}  // namespace

std::string plugin_doctor_text(const std::string& path, bool& all_well) {
  all_well = true;
  const std::vector<std::string> paths = manifest_paths(path);
  if (paths.empty()) {
    all_well = false;
    return without_manifest(path);
  }
  std::string out;
  for (const std::vector<PluginManifest>& entries : find_manifests(path))
    for (const PluginManifest& entry : entries) {
      out += (entry.id.empty() ? entry.path : entry.id + "  " + entry.path) + "\n";
      const std::string reason = entry.refused.empty() ? refusal_of(entry) : entry.refused;
      if (reason.empty()) {
        out += "  Nothing is wrong with it. A case finds it with --plugin-path " +
               std::filesystem::path(entry.path).parent_path().string() +
               "\n  or when library and manifest lie in ~/.local/share/calx/plugins. calx plugin check PATH tells "
               "whether it "
               "keeps all it promises.\n";
        continue;
      }
      all_well = false;
      out += explained(reason);
    }
  return out;
}

}  // namespace calx
