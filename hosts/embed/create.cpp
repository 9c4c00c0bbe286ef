// create.cpp: simulations made, destroyed, saved and loaded; the last error of a thread.
#include <dlfcn.h>

#include <cstring>
#include <filesystem>

#include "base/version.hpp"
#include "io/io.hpp"
#include "sim/whole_case.hpp"
#include "simulation.hpp"

namespace calx {
namespace {

std::string& last_error() {
  thread_local std::string message;
  return message;
}

/// The folders that the caller gives, then those beside this library: of an installation and of a build tree.
std::vector<std::string> plugin_folders(const char* listed) {
  std::vector<std::string> out;
  const std::string text = listed ? listed : "";
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(':', from), text.size());
    if (to > from) out.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  Dl_info self{};
  if (!dladdr(reinterpret_cast<const void*>(&calx_sim_error), &self) || !self.dli_fname) return out;
  std::error_code bad;
  const std::filesystem::path beside = std::filesystem::canonical(self.dli_fname, bad).parent_path();
  for (const char* place : {"calx/plugins", "../plugins"})
    if (!bad && std::filesystem::is_directory(beside / place)) out.push_back((beside / place).string());
  return out;
}

/// The caller's options, of whatever size they have.
calx_sim_options known(const calx_sim_options* given) {
  calx_sim_options out{};
  if (!given) return out;
  constexpr std::uint32_t first = 2 * sizeof(std::uint32_t) + 6 * sizeof(void*);  // of release 0.1
  if (given->struct_size < first)
    misused("calx_sim_options: struct_size is " + std::to_string(given->struct_size) +
            "; set it to sizeof(calx_sim_options)");
  std::memcpy(&out, given, std::min<std::size_t>(sizeof out, given->struct_size));
  return out;
}

SimulationOptions simulation_options(const calx_sim_options& o) {
  SimulationOptions out;
  if (o.threads < 0) misused("calx_sim_options: threads is " + std::to_string(o.threads) + "; 0 means all cores");
  out.threads = o.threads;
  if (o.device) out.device = o.device;
  const std::string precision = o.precision ? o.precision : "double";
  if (precision != "double" && precision != "mixed")
    misused("calx_sim_options: precision is \"" + precision + "\"; expected \"double\" or \"mixed\"");
  out.mixed = precision == "mixed";
  out.plugin_path = plugin_folders(o.plugin_path);
  for (auto entry = o.plugins; entry && *entry; ++entry) out.plugins.push_back(*entry);
  return out;
}

std::vector<std::pair<std::string, std::string>> overrides(const calx_sim_options& o) {
  std::vector<std::pair<std::string, std::string>> out;
  for (auto text = o.set; text && *text; ++text) {
    const std::string one = *text;
    const auto at = one.find('=');
    if (at == std::string::npos || one[0] != '/')
      misused("calx_sim_options: set holds \"" + one + "\"; expected /json/pointer=value");
    out.emplace_back(one.substr(0, at), one.substr(at + 1));
  }
  return out;
}

template <class Read>
std::int32_t create(const char* function, const char* text, const calx_sim_options* options, calx_sim** out,
                    const Read& read) noexcept {
  return guarded([&] {
    needed(text, function, "the case");
    needed(out, function, "out");
    const calx_sim_options o = known(options);
    auto sim = std::make_unique<calx_sim>();
    sim->simulation = std::make_unique<Simulation>(whole_case(read(o)), simulation_options(o));
    for (const auto& sensor : sim->simulation->sensors()) sim->columns.push_back(sensor->columns());
    *out = sim.release();
  });
}

}  // namespace

std::int32_t failed(std::int32_t code, const std::string& message) noexcept {
  try {
    last_error() = message;
  } catch (...) {  // no memory for the message; the code says enough
    last_error().clear();
  }
  return code;
}

}  // namespace calx

using namespace calx;

const char* calx_sim_error(void) { return last_error().c_str(); }
const char* calx_sim_version(void) { return version(); }

std::int32_t calx_sim_create(const char* case_json, const calx_sim_options* options, calx_sim** out) {
  return create("calx_sim_create", case_json, options, out, [&](const calx_sim_options& o) {
    // Stands in messages; relative paths start in its folder.
    const std::filesystem::path folder = o.folder ? o.folder : ".";
    return parse_case(case_json, (folder / "case given as text").string(), overrides(o));
  });
}

std::int32_t calx_sim_open(const char* case_path, const calx_sim_options* options, calx_sim** out) {
  return create("calx_sim_open", case_path, options, out,
                [&](const calx_sim_options& o) { return read_case(case_path, overrides(o)); });
}

void calx_sim_destroy(calx_sim* sim) { delete sim; }

std::int32_t calx_sim_save(const calx_sim* sim, const char* folder) {
  return guarded([&] {
    const Simulation& s = *needed(sim, "calx_sim_save", "sim").simulation;
    write_checkpoint(&needed(folder, "calx_sim_save", "folder"), [&](StateWriter& state) { s.save(state); });
  });
}

std::int32_t calx_sim_load(calx_sim* sim, const char* folder) {
  return guarded([&] {
    Simulation& s = *needed(sim, "calx_sim_load", "sim").simulation;
    s.load(*read_checkpoint(&needed(folder, "calx_sim_load", "folder")));
  });
}

std::int32_t calx_sim_digest(const calx_sim* sim, char text[65]) {
  return guarded([&] {
    const std::string digest = needed(sim, "calx_sim_digest", "sim").simulation->digest();
    std::memcpy(&needed(text, "calx_sim_digest", "text"), digest.c_str(), std::min<std::size_t>(digest.size() + 1, 65));
  });
}
