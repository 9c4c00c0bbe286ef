// bench.cpp: the command line of timed scenes.
#include "bench.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "bench_scene.hpp"
#include "options.hpp"

namespace calx {
namespace {

const std::vector<std::string> kCases{"law",  "settled", "pour",   "sizes", "penetration",
                                      "drum", "chute",   "clumps", "fill"};
constexpr char kFill[] = "examples/canister_fill/first_fill.json";

BenchScene scene_of(const BenchOptions& o, const std::string& folder) {
  if (o.name == "pour") return pour_scene(o);
  if (o.name == "sizes") return sizes_scene(o);
  if (o.name == "clumps") return clumps_scene(o);
  if (o.name == "penetration") return penetration_scene(o);
  if (o.name == "drum") return drum_scene(o, folder);
  if (o.name == "chute") return chute_scene(o, folder);
  return settled_scene(o);
}

std::string fill_case(const BenchOptions& o) {
  if (!o.case_path.empty()) return o.case_path;
  if (!std::filesystem::exists(kFill))
    throw Error(Fault::usage,
                std::string("bench fill: ") + kFill + " is not below the working directory; give a case with --case");
  return kFill;
}

void run_bench(BenchOptions& o, const std::vector<std::string>& set) {
  for (const std::string& text : set) o.overrides.push_back(split_override(text, "/neighbour/skin=1e-4"));
  if (o.precision != "double" && o.precision != "mixed")
    throw Error(Fault::usage, "--precision " + o.precision + ": \"double\" or \"mixed\"");
  if (o.name == "law") {
    bench_law(o);
    return;
  }
  if (o.name == "fill") {
    time_case(read_scene(fill_case(o), o), scene_physics(o.name), o);
    return;
  }
  std::string path = o.start + "/case.json";
  // A scene's files are read before the first step.
  const bool saved = std::filesystem::is_directory(o.start);
  const BenchFolder folder(saved ? o.start : o.save_start);
  if (!saved) path = write_scene(scene_of(o, folder.path()), folder.path());
  time_case(read_scene(path, o), scene_physics(o.name), o);
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "timed scenes: one row of speed, memory and physics for each run");
  auto b = std::make_shared<BenchOptions>();
  auto set = std::make_shared<std::vector<std::string>>();
  command->add_option("case", b->name, "law, settled, pour, sizes, penetration, drum, chute, clumps or fill")
      ->check(CLI::IsMember(kCases));
  command->add_option("--particles", b->particles, "number of particles (default: as the case is defined)")
      ->check(whole_above_zero());
  command->add_option("--threads", b->threads, "threads (default: 1)")->check(whole_above_zero());
  command->add_option("--steps", b->steps, "timed steps (default: 400)")->check(whole_above_zero());
  command->add_option("--warm-up", b->warm_up, "steps before timing (default: 100)")->check(whole_number());
  command->add_option("--at", b->at, "simulate to this time first, untimed, s")->check(zero_or_more());
  command->add_option("--rolling", b->rolling, "rolling friction, 0 for none")->check(zero_or_more());
  command->add_option("--device", b->device, "cpu, opencl[:i], cuda[:i] or auto");
  command->add_option("--precision", b->precision, "double, or mixed: pair contacts in single precision");
  command->add_option("--set", *set, "override in the case, repeatable: /json/pointer=value");
  command->add_option("--settle", b->settle, "settle the start for this long, s (default: until it rests)")
      ->check(zero_or_more());
  command->add_option("--start", b->start,
                      "a folder of --save-start, which is run as it is, or a CSV with the settled tile of 50 x 50 mm "
                      "or the settled bed (default: settle one)");
  command->add_option("--save", b->save, "write the settled tile or bed to this CSV");
  command->add_option("--save-start", b->save_start, "write the whole start to this folder: case.json and CSV files");
  command->add_option("--law", b->law, "clumps: calx.epam (default) or calx.hertz-mindlin");
  command->add_option("--base", b->base, "chute: bumps (default) or plane");
  command->add_option("--case", b->case_path, std::string("fill: the case file (default: ") + kFill + ")");
  command->add_option("--plugin-path", b->plugin_path, "folder with plugins, searched first; repeatable");
  command->add_flag("--json", b->json, "one JSON line for each row");
  command->callback([b, set] { run_bench(*b, *set); });
}

}  // namespace calx
