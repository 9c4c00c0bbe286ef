// library_checks.cpp: what every library keeps, whatever it holds: symbols, life cycle, manifest, floating-point mode.
#include <elf.h>
#include <time.h>

#include <algorithm>
#include <clocale>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "base/nearest.hpp"
#include "conformance/checks.hpp"
#include "plugin/float_mode.hpp"
#include "plugin/host.hpp"
#include "plugin/manifest.hpp"
#include "plugin/refused.hpp"

namespace calx::conformance {
namespace {

/// The dynamic symbols a library defines and the libraries it needs, read from the file.
struct Elf {
  std::vector<std::string> defined, needed;

  explicit Elf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
    const auto* head = at<Elf64_Ehdr>(0);
    if (!head || std::memcmp(head->e_ident, ELFMAG, SELFMAG) != 0 || head->e_ident[EI_CLASS] != ELFCLASS64)
      throw Skipped{"not a 64-bit ELF library"};
    for (unsigned k = 0; k < head->e_shnum; ++k) {
      const auto* section = at<Elf64_Shdr>(head->e_shoff + k * sizeof(Elf64_Shdr));
      const auto* names = section ? at<Elf64_Shdr>(head->e_shoff + section->sh_link * sizeof(Elf64_Shdr)) : nullptr;
      if (!names) continue;
      if (section->sh_type == SHT_DYNSYM) read_symbols(*section, names->sh_offset);
      if (section->sh_type == SHT_DYNAMIC) read_needed(*section, names->sh_offset);
    }
  }

 private:
  template <class T>
  const T* at(std::uint64_t offset) const {
    if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return nullptr;
    return reinterpret_cast<const T*>(bytes.data() + offset);
  }
  std::string text(std::uint64_t offset) const {
    if (offset >= bytes.size()) return "";
    return std::string(bytes.data() + offset, strnlen(bytes.data() + offset, bytes.size() - offset));
  }
  void read_symbols(const Elf64_Shdr& section, std::uint64_t names) {
    for (std::uint64_t k = 0; k < section.sh_size / sizeof(Elf64_Sym); ++k) {
      const auto* symbol = at<Elf64_Sym>(section.sh_offset + k * sizeof(Elf64_Sym));
      if (!symbol) return;
      const bool defines = symbol->st_shndx != SHN_UNDEF && symbol->st_shndx < SHN_LORESERVE;
      if (defines && ELF64_ST_BIND(symbol->st_info) != STB_LOCAL) defined.push_back(text(names + symbol->st_name));
    }
  }
  void read_needed(const Elf64_Shdr& section, std::uint64_t names) {
    for (std::uint64_t k = 0; k < section.sh_size / sizeof(Elf64_Dyn); ++k) {
      const auto* entry = at<Elf64_Dyn>(section.sh_offset + k * sizeof(Elf64_Dyn));
      if (!entry) return;
      if (entry->d_tag == DT_NEEDED) needed.push_back(text(names + entry->d_un.d_val));
    }
  }
  std::vector<char> bytes;
};

Elf elf_of(const Subject& subject) {
  if (!subject.manifest().text.empty()) throw Skipped{"a law text has no library"};
  return Elf(subject.manifest().library);
}

// To load is all that every Subject does.
std::string loads(Subject&) { return ""; }

std::string one_symbol(Subject& subject) {
  const Elf elf = elf_of(subject);
  std::vector<std::string> others;
  for (const std::string& name : elf.defined)
    if (name != "calx_plugin_entry") others.push_back(name);
  if (others.size() > 3) others.resize(3);
  require(others.empty(),
          "it also exports " + quoted_list(others) +
              "; compile with -fvisibility=hidden and link with a version script, as calx_add_plugin does");
  return "";
}

std::string dependencies(Subject& subject) {
  const Elf elf = elf_of(subject);
  std::vector<std::string> others;
  // Sanitizers are the only ones that a build brings along on purpose.
  for (const std::string& name : elf.needed)
    if (name.rfind("libc.so", 0) && name.rfind("libm.so", 0) && name.rfind("ld-", 0) && name.rfind("ld64", 0) &&
        name.rfind("libasan", 0) && name.rfind("libubsan", 0) && name.rfind("libtsan", 0))
      others.push_back(name);
  require(others.empty(), "it needs " + quoted_list(others) +
                              ", which another machine may lack or hold in another version; link them into the plugin");
  return "";
}

std::string scan_time(Subject& subject) {
  // Processor time, so that a busy machine does not count; best of three, since the first reads from the disk.
  double best = 1e9;
  for (int k = 0; k < 3; ++k) {
    timespec before{}, after{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    read_manifest(subject.manifest().path);
    const calx_entry& entry = subject.library().entry();
    entry.init(subject.library().host().table(), "");
    const auto* factory = static_cast<const calx_factory*>(entry.get_factory(CALX_FACTORY));
    for (std::uint32_t m = 0; factory && m < factory->count(); ++m) factory->descriptor(m);
    entry.deinit();
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    best = std::min(best, static_cast<double>(after.tv_sec - before.tv_sec) +
                              1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec));
  }
  require(best < 0.1, "reading its manifest, init and descriptors take " + short_number(best) +
                          " s of processor time; listing plugins should take less than 0.1 s");
  return short_number(best * 1e3) + " ms";
}

std::string nested_init(Subject& subject) {
  const calx_entry& entry = subject.library().entry();
  const calx_host* host = subject.library().host().table();
  for (int k = 0; k < 3; ++k) require(entry.init(host, "") >= 0, "init failed when it was called again");
  for (int k = 0; k < 3; ++k) entry.deinit();
  require(subject.any() != nullptr, "");
  exercise(subject);
  return "";
}

std::string unknown_ids(Subject& subject) {
  const calx_entry& entry = subject.library().entry();
  for (const char* id : {"", "calx.factory", "calx.factory/12", "calx.factory/1x", "org.example.nothing/1"})
    require(entry.get_factory(id) == nullptr,
            std::string("get_factory(\"") + id + "\") gives a table; compare the whole id");
  const calx_factory& factory = subject.library().factory();
  require(factory.descriptor(factory.count()) == nullptr, "descriptor(count()) is not null");
  require(factory.descriptor(0xFFFFFFFFu) == nullptr, "descriptor(4294967295) is not null");
  const InstancePtr instance = subject.any();
  for (const std::string& id : {std::string(""), subject.manifest().kind + "2", subject.manifest().kind + "x",
                                std::string("org.example.nothing/1")})
    require(instance->table(id.c_str()) == nullptr,
            "get_interface(\"" + id + "\") gives a table; compare the whole id");
  const calx_config config = {sizeof(calx_config), 0, nullptr, "{}", 2};
  calx_instance* made = nullptr;
  require(factory.create("org.example.nothing", subject.library().host().table(), &config, &made) < 0 && !made,
          "create makes an instance for an id that the library does not hold");
  return "";
}

std::string manifest_agrees(Subject& subject) {
  const std::vector<PluginManifest> entries = read_manifest(subject.manifest().path);
  std::set<std::string> told;
  for (const PluginManifest& entry : entries) {
    const calx_descriptor& d = subject.library().descriptor(entry);
    told.insert(entry.id);
    require(entry.license == d.license, "the manifest says " + entry.id + " has the licence " + entry.license +
                                            ", its descriptor says " + d.license);
    require(entry.summary == d.summary, "the manifest sums " + entry.id + " up as \"" + entry.summary +
                                            "\", its descriptor as \"" + d.summary + "\"");
  }
  for (const calx_descriptor* d : subject.library().descriptors())
    require(told.count(d->id) > 0, std::string("the library holds ") + d->id + ", which the manifest does not name");
  return std::to_string(entries.size()) + (entries.size() == 1 ? " plugin" : " plugins");
}

std::string fp_environment(Subject& subject) {
  const FloatMode before = FloatMode::now();
  exercise(subject);
  const FloatMode after = FloatMode::now();
  require(after == before, "it changed the floating-point mode (" + before.text() + " became " + after.text() +
                               "); results of every other plugin would change with it");
  return "";
}

std::string locale(Subject& subject) {
  const char* found = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8", "nl_NL.UTF-8"})
    if (std::setlocale(LC_ALL, name)) {
      found = name;
      break;
    }
  if (!found) throw Skipped{"no locale with a decimal comma is installed; sudo locale-gen de_DE.UTF-8"};
  exercise(subject);
  return found;
}

}  // namespace

std::vector<Check> library_checks() {
  return {{"loads", "The library loads, and its entry, factory and descriptors are in order.", nullptr, false, loads},
          {"one-symbol", "The library exports calx_plugin_entry and nothing else.", nullptr, false, one_symbol},
          {"dependencies", "The library needs the C and mathematics libraries only.", nullptr, false, dependencies},
          {"manifest-agrees", "Manifest and descriptors tell the same.", nullptr, false, manifest_agrees},
          {"scan-time", "Listing the plugin takes less than 0.1 s of processor time.", nullptr, false, scan_time}};
}

std::vector<Check> life_checks() {
  return {{"nested-init", "init and deinit may be called several times, in pairs.", "", false, nested_init},
          {"unknown-ids", "Ids are compared as a whole; unknown ones give null.", "", false, unknown_ids},
          {"fp-environment", "The floating-point mode of the process is left alone.", "", false, fp_environment},
          {"locale", "The plugin works where numbers are written with a comma.", "", false, locale}};
}

}  // namespace calx::conformance
