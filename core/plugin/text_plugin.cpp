#include "plugin/text_plugin.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "base/units.hpp"
#include "compute/device_cache.hpp"
#include "compute/device_text.hpp"
#include "compute/host_compiler.hpp"
#include "plugin/law_lint.hpp"
#include "plugin/refused.hpp"

namespace calx {
namespace {

/// A header of the ABI without its includes of others, which stand before it.
std::string header(const char* name) {
  std::istringstream lines{std::string(kernel_text(name))};
  std::string out = "#line 1 \"" + std::string(name) + "\"\n";
  for (std::string line; std::getline(lines, line); out += "\n") {
    const bool own = line.rfind("#include \"", 0) == 0 || line.rfind("#include <calx/", 0) == 0;
    if (!own) out += line;
  }
  return out;
}

/// A C string literal of any bytes. An @ is written as a number, so that no text is taken for a place to fill in.
std::string literal(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c >= ' ' && c <= '~' && c != '"' && c != '\\' && c != '?' && c != '@') {
      out += c;
      continue;
    }
    char code[8];
    std::snprintf(code, sizeof code, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += code;
  }
  return out + "\"";
}

std::string text_bytes(const std::string& text) {
  std::string out = "static const char calx_text[] = {";
  for (std::size_t k = 0; k < text.size(); ++k)
    out += (k % 32 == 0 ? "\n" : "") + std::to_string(static_cast<int>(text[k])) + ",";
  return out + "0};\n";
}

constexpr const char* kLaw = R"(
CALX_LAW_TABLES(@SYMBOL@)
struct calx_instance { char unused; };
static calx_instance the_instance;
__attribute__((unused)) static double CALX_CALL stable_dt(const double* pair, double m_eff, double r_eff, double overlap) {
  double k = 0.0, modulus = 0.0;
@STIFFNESS@@MODULUS@  (void)pair;
  /* Hertz: slope of 4/3 E sqrt(r) overlap^1.5. */
  k += 2.0 * modulus * sqrt(r_eff * (overlap > 0.0 ? overlap : 0.0));
  /* A tenth of the period of mass and stiffest spring, 2 pi sqrt(m / k). */
  return k > 0.0 ? 0.62831853071795865 * sqrt(m_eff / k) : HUGE_VAL;
}
__attribute__((unused)) static double CALX_CALL reach(const double* pair, double, double) {
  double gap = 0.0;
@GAPS@  (void)pair;
  return gap;
}
static calx_contact_law make_law() {
  calx_contact_law law = calx_contact_law();
  CALX_LAW_FILL(law, @SYMBOL@);
  law.flags = CALX_LAW_EXACT;
  law.given_count = law.pair_count;
  law.given = law.pair;
  law.stable_dt = @STABLE@;
  law.reach = @REACH@;
  law.source = calx_text;
  law.source_size = sizeof calx_text - 1;
  law.source_sha256 = @SHA256@;
  return law;
}
static const calx_contact_law the_table = make_law();
extern "C" { CALX_EXPORT extern const calx_contact_law* const calx_text_table; const calx_contact_law* const calx_text_table = &the_table; }
#define PARAMETERS 0, 0
static calx_status make(const calx_config*, calx_instance** out) { *out = &the_instance; return CALX_OK; }
static void CALX_CALL destroy(calx_instance*) {}
)";

constexpr const char* kForce = R"(
CALX_FORCE_BATCH(@SYMBOL@)
static const uint32_t row_count = sizeof @SYMBOL@_row_fields / sizeof *@SYMBOL@_row_fields - 1;
struct calx_instance { double row[sizeof @SYMBOL@_row_fields / sizeof *@SYMBOL@_row_fields]; };
static void CALX_CALL eval(const calx_instance* self, const calx_particle_block* block) { @SYMBOL@_batch(self->row, block); }
static void CALX_CALL numbers(const calx_instance* self, double* row) {
  for (uint32_t k = 0; k < row_count; ++k) row[k] = self->row[k];
}
static const calx_particle_force the_table = {sizeof(calx_particle_force), CALX_ABI_DRAFT, eval, 1, row_count,
  @SYMBOL@_row_fields, "@SYMBOL@", calx_text, sizeof calx_text - 1, @SHA256@, numbers};
#define PARAMETERS @SYMBOL@_row_fields, row_count
static calx_status make(const calx_config* config, calx_instance** out) {
  calx_instance* made = new (std::nothrow) calx_instance();
  if (!made) return CALX_E_MEMORY;
  for (uint32_t k = 0; k < row_count; ++k) made->row[k] = config->value[k];
  *out = made;
  return CALX_OK;
}
static void CALX_CALL destroy(calx_instance* instance) { delete instance; }
)";

constexpr const char* kEntry = R"(
static const calx_descriptor the_descriptor = {sizeof(calx_descriptor), 0, @ID@, @KIND@, @ID@, @VERSION@, @VENDOR@, @LICENSE@, @SUMMARY@,
  0, PARAMETERS, 0, 0};
static uint32_t CALX_CALL count() { return 1; }
static const calx_descriptor* CALX_CALL descriptor(uint32_t index) { return index == 0 ? &the_descriptor : 0; }
static calx_status CALX_CALL create(const char* id, const calx_host* host, const calx_config* config, calx_instance** out) {
  if (strcmp(id, @ID@) != 0) return host->fail(host, CALX_E_UNSUPPORTED, "this text is another plugin");
  return make(config, out);
}
static const void* CALX_CALL get_interface(calx_instance*, const char* id) { return strcmp(id, @KIND@) == 0 ? &the_table : 0; }
static const calx_factory the_factory = {count, descriptor, create, destroy, get_interface};
static calx_status CALX_CALL init(const calx_host*, const char*) { return CALX_OK; }
static void CALX_CALL deinit() {}
static const void* CALX_CALL get_factory(const char* id) { return strcmp(id, CALX_FACTORY) == 0 ? &the_factory : 0; }
extern "C" { CALX_EXPORT extern const calx_entry calx_plugin_entry; const calx_entry calx_plugin_entry = {CALX_ABI_MAGIC,
  CALX_ABI_MAJOR, CALX_ABI_MINOR, sizeof(calx_entry), 0, init, deinit, get_factory}; }
)";

/// Sets a variable to the largest of some columns of the pair row.
std::string largest_lines(const std::string& symbol, const std::vector<std::string>& columns, const std::string& of) {
  std::string out;
  for (const std::string& name : columns) {
    const std::string value = "pair[offsetof(" + symbol + "_pair_f64, " + name + ") / sizeof(double)]";
    out += "  " + of + " = " + value + " > " + of + " ? " + value + " : " + of + ";\n";
  }
  return out;
}

/// Throws Refused where a column that the manifest names under key has not the unit that the generated code takes it to
/// have.
void check_unit(const PluginManifest& manifest, const calx_contact_law& law, const char* key,
                const std::vector<std::string>& columns, const std::string& unit) {
  for (std::uint32_t k = 0; k < law.pair_count; ++k) {
    const calx_field& field = law.pair[k];
    if (std::find(columns.begin(), columns.end(), field.name) == columns.end()) continue;
    const Unit given = parse_unit(field.unit);
    if (same_dimension(given, parse_unit(unit))) continue;
    const bool hertz = unit == "N/m" && same_dimension(given, parse_unit("Pa"));
    throw Refused{manifest.path + " \"" + key + "\": column \"" + field.name + "\" is in " + field.unit +
                  ", it must be in " + unit + (hertz ? "; the modulus of a Hertz law belongs under \"modulus\"" : "")};
  }
}

/// The text in one precision, as plugins include it.
std::string one_precision(const char* bits, const std::string& law, const std::string& name, const char* wrapper) {
  return std::string("#undef CALX_BITS\n#define CALX_BITS ") + bits + "\n" + header("prelude.h") + header("sliding.h") +
         header("rolling.h") + "\n#line 1 \"" + name + "\"\n" + law + "\n" + header(wrapper);
}

std::string generate(const PluginManifest& manifest, const std::string& law, const std::string& name) {
  const bool is_law = manifest.kind == CALX_CONTACT_LAW;
  std::string out = "#include <math.h>\n#include <stddef.h>\n#include <string.h>\n#include <new>\n" + header("abi.h") +
                    header(is_law ? "contact_law.h" : "particle_force.h") + text_bytes(law);
  if (is_law) {
    const std::string batch = "CALX_LAW_BATCH(" + manifest.symbol + ")\n";
    out += one_precision("32", law, name, "native.h") + batch + one_precision("64", law, name, "native.h") + batch;
  } else {
    out += one_precision("64", law, name, "force_native.h");
  }
  std::string entry = std::string(is_law ? kLaw : kForce) + kEntry;
  entry = replaced(entry, "@SYMBOL@", manifest.symbol);
  entry = replaced(entry, "@STIFFNESS@", largest_lines(manifest.symbol, manifest.stiffness, "k"));
  entry = replaced(entry, "@MODULUS@", largest_lines(manifest.symbol, manifest.modulus, "modulus"));
  entry = replaced(entry, "@GAPS@", largest_lines(manifest.symbol, manifest.reach, "gap"));
  entry = replaced(entry, "@REACH@", manifest.reach.empty() ? "0" : "reach");
  entry = replaced(entry, "@STABLE@", manifest.stiffness.empty() && manifest.modulus.empty() ? "0" : "stable_dt");
  for (const auto& each : std::map<std::string, std::string>{{"SHA256", sha256(law.data(), law.size())},
                                                             {"ID", manifest.id},
                                                             {"KIND", manifest.kind},
                                                             {"VERSION", manifest.version},
                                                             {"VENDOR", manifest.vendor},
                                                             {"LICENSE", manifest.license},
                                                             {"SUMMARY", manifest.summary}})
    entry = replaced(entry, "@" + each.first + "@", literal(each.second));
  return out + "#line 1 \"made by calx\"\n" + entry;
}

/// The first errors a compiler tells of, one a line.
std::string first_errors(const std::string& log) {
  std::istringstream lines(log);
  std::string out;
  int most = 3;
  for (std::string line; most > 0 && std::getline(lines, line);) {
    if (line.find("error") == std::string::npos) continue;
    out += "\n  " + line;
    --most;
  }
  return out.empty() ? "\n  " + log.substr(0, 500) : out;
}

}  // namespace

const calx_entry& compile_text_plugin(const PluginManifest& manifest, const std::string& text) {
  static std::mutex mutex;
  static std::map<std::string, const calx_entry*> compiled;
  const std::string name = std::filesystem::path(manifest.text).filename().string();
  const std::string stem = name.substr(0, name.find(".law.h"));
  const std::vector<LintFinding> findings = lint_law(text, stem);
  if (!findings.empty()) throw Refused{manifest.text + " breaks the dialect of laws: " + lint_text(findings, name)};

  const std::string whole = generate(manifest, text, name);
  const std::lock_guard<std::mutex> lock(mutex);
  const auto known = compiled.find(whole);
  if (known != compiled.end()) return *known->second;
  try {
    const HostCompiler compiler = find_host_compiler();
    if (compiler.version.empty())
      throw Refused{manifest.text + " is a law text without native code and needs a C++ compiler; \"" +
                    compiler.command.front() + "\" does not start. Install g++, or set CALX_CXX"};
    DeviceCache cache("");
    std::vector<std::string> parts = compiler.command;
    parts.insert(parts.end(), {compiler.version, whole, "text plugin"});
    const std::string key = DeviceCache::key(parts);
    std::optional<CompiledModule> module = cache.load(key);
    if (!module) {
      module = compile_on_host(compiler, whole, false);
      if (module->image.empty()) throw Refused{manifest.text + " does not compile:" + first_errors(module->log)};
      cache.store(key, *module);
    }
    void* const library = open_image(module->image);
    const void* entry = dlsym(library, "calx_plugin_entry");
    if (!entry) throw Refused{manifest.text + ": its compiled form exports no calx_plugin_entry"};
    if (const void* table = dlsym(library, "calx_text_table")) {
      const auto& law = **static_cast<const calx_contact_law* const*>(table);
      check_unit(manifest, law, "stiffness", manifest.stiffness, "N/m");
      check_unit(manifest, law, "modulus", manifest.modulus, "Pa");
      check_unit(manifest, law, "reach", manifest.reach, "m");
    }
    compiled[whole] = static_cast<const calx_entry*>(entry);
    return *compiled[whole];
  } catch (const Error& e) {
    throw Refused{manifest.text + ": " + e.what()};
  }
}

}  // namespace calx
