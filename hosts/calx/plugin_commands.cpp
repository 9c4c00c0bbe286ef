#include "plugin_commands.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "conformance/conformance.hpp"
#include "options.hpp"
#include "plugin/plugin.hpp"

namespace calx {
namespace {

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

struct CheckFlags {
  std::string path, page;
  CheckOptions options;
  double fuzz = 0;
  bool json = false, names = false;
};

void check(const CheckFlags& flags) {
  if (flags.names) {
    for (const auto& check : check_names()) std::printf("%-18s %s\n", check.first.c_str(), check.second.c_str());
    return;
  }
  if (flags.path.empty())
    throw Error(Fault::usage, "plugin check: a path is needed: a manifest NAME.plugin.json, its library or a folder");
  std::uint64_t rounds = 0;
  const CheckReport report = flags.fuzz > 0 ? fuzz_plugins(flags.path, flags.options, flags.fuzz, rounds)
                                            : check_plugins(flags.path, flags.options);
  print(flags.json ? check_json(report) : check_text(report, true));
  if (rounds > 0 && !flags.json) std::printf("%llu rounds\n", static_cast<unsigned long long>(rounds));
  if (!flags.page.empty()) write_check_page(report, flags.page);
  const std::size_t failed = report.count(CheckOutcome::failed);
  if (failed > 0)
    throw Error(Fault::plugin,
                flags.path + ": " + std::to_string(failed) + (failed == 1 ? " check" : " checks") + " failed");
}

/// The manifest of an id, where path is none that exists. Throws Error(Fault::files).
std::string manifest_of(const std::string& path, const std::vector<std::string>& search) {
  if (std::filesystem::exists(path)) return path;
  std::vector<std::string> known;
  for (const PluginManifest& manifest : discover_plugins(plugin_search_path(search))) {
    if (manifest.id == path) return manifest.path;
    known.push_back(manifest.id);
  }
  const std::string near = nearest_name(path, known);
  throw Error(Fault::files, path + ": no such file, and no plugin found is called so; " +
                                (near.empty() ? "give a manifest NAME.plugin.json, its library, a folder, or an id"
                                              : "did you mean \"" + near + "\"?"));
}

}  // namespace

void add_plugin_command(CLI::App& app) {
  auto* command = app.add_subcommand("plugin", "list, describe, check, explain and begin plugins");
  command->require_subcommand(1);
  // Callbacks outlive this function; the program has one command line.
  static std::vector<std::string> search;
  static std::string id, name, kind, folder = ".", path;
  static CheckFlags flags;

  auto* list = command->add_subcommand("list", "every plugin found, and what was refused and why");
  list->callback([] { print(plugin_list_text(plugin_search_path(search))); });
  auto* describe = command->add_subcommand("describe", "parameters with units, ranges and presets");
  describe->add_option("id", id, "plugin id")->required();
  describe->callback([] { print(plugin_describe_text(id, plugin_search_path(search))); });
  auto* schema = command->add_subcommand("schema", "JSON Schema of a plugin's parameters");
  schema->add_option("id", id, "plugin id")->required();
  schema->callback([] { print(plugin_schema_text(id, plugin_search_path(search))); });
  for (auto* each : {list, describe, schema})
    each->add_option("--plugin-path", search, "folder with plugins, searched first; repeatable");

  auto* check_command = command->add_subcommand("check", "does a plugin keep what the ABI asks of it?");
  check_command->add_option("path", flags.path, "a manifest NAME.plugin.json, its library, or a folder of manifests");
  check_command->add_option("--only", flags.options.only, "one check");
  check_command->add_flag("--names", flags.names, "list the checks");
  check_command->add_flag("--json", flags.json, "the result as JSON on stdout");
  check_command->add_option("--page", flags.page,
                            "write the result to this HTML file, with curves of a law or motion, pictures of a shape");
  check_command->add_option("--seed", flags.options.seed, "seed of random inputs (default 1)")->check(whole_number());
  check_command->add_option("--time-limit", flags.options.limit, "for each check, s (default 60)")
      ->check(zero_or_more());
  check_command->add_option("--fuzz", flags.fuzz, "repeat the random checks with rising seeds for so many seconds")
      ->check(zero_or_more());
  check_command->add_flag("--in-process", flags.options.in_process,
                          "no child processes, for debuggers: a crash ends the program");
  check_command->callback([] { check(flags); });

  auto* doctor = command->add_subcommand("doctor", "why is a plugin refused, and what helps?");
  doctor->add_option("path", path, "a manifest, a library or a folder, or the id of a plugin that is found")
      ->required();
  doctor->add_option("--plugin-path", search, "folder with plugins, searched first; repeatable");
  doctor->callback([] {
    bool all_well = true;
    print(plugin_doctor_text(manifest_of(path, search), all_well));
    if (!all_well) throw Error(Fault::plugin, path + ": not all is well, see above");
  });

  auto* fresh = command->add_subcommand("new", "write a plugin project that is ready to build");
  fresh->add_option("name", name, "its name: lower-case letters, digits and -, as in wet-hertz")->required();
  fresh->add_option("--kind", kind, "one of " + quoted_list(new_plugin_kinds()))->required();
  fresh->add_option("--in", folder, "folder to write it into (default: here)");
  fresh->callback([] {
    for (const std::string& file : new_plugin(name, kind, folder)) std::printf("%s\n", file.c_str());
    print(new_plugin_advice(name, kind, folder));
  });
}

}  // namespace calx
