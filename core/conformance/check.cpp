// check.cpp: which checks run on which plugin, each in a child process, and what their ends mean.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "conformance/checks.hpp"
#include "conformance/find.hpp"
#include "plugin/child.hpp"
#include "plugin/refused.hpp"

namespace calx {

using namespace conformance;
using nlohmann::json;

namespace {

std::vector<Check> every_check() {
  std::vector<Check> all;
  for (const auto& group :
       {library_checks(), table_checks(), life_checks(), text_checks(), law_checks(), law_energy_checks(),
        geometry_checks(), motion_checks(), force_checks(), sensor_checks(), state_checks()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

constexpr const char* kManifest = "manifest";
constexpr const char* kManifestMeaning = "The manifest is read, and its library lies beside it, safe to load.";
constexpr const char* kSilent = "silent";
constexpr const char* kSilentMeaning = "Nothing is written to stdout or stderr.";

json outcome_of(CheckOutcome outcome, const std::string& detail) {
  return {{"outcome", static_cast<int>(outcome)}, {"detail", detail}};
}

/// Runs in the child. Never throws.
json judge(const Check& check, const PluginManifest& manifest, std::uint64_t seed) noexcept {
  try {
    Subject subject(manifest, seed);
    return outcome_of(CheckOutcome::passed, check.run(subject));
  } catch (const Failed& failed) {
    return outcome_of(CheckOutcome::failed, failed.detail);
  } catch (const Skipped& skipped) {
    return outcome_of(CheckOutcome::skipped, skipped.reason);
  } catch (const Refused& refused) {
    return outcome_of(CheckOutcome::failed, refused.reason);
  } catch (const std::exception& e) {
    return outcome_of(CheckOutcome::failed, e.what());
  }
}

class Runner {
 public:
  explicit Runner(const CheckOptions& options) : options_(options) {}

  /// entries: all plugins of one manifest.
  CheckedManifest run(const std::vector<PluginManifest>& entries) {
    CheckedManifest out;
    out.path = entries.front().path;
    const std::string file = std::filesystem::path(out.path).filename().string();
    printed_.clear();
    if (!check_manifest(entries, file, out) || !has_code(entries.front())) return out;
    const std::vector<Check> all = every_check();
    // Where one of these fails, every other check would tell the same once more.
    const auto stops = [&](const char* name) {
      return !out.results.empty() && out.results.back().name == name &&
             out.results.back().outcome == CheckOutcome::failed;
    };
    for (const Check& check : all) {
      if (!check.kind) add(check, entries.front(), file, out);
      if (stops("loads")) return out;
    }
    for (const PluginManifest& entry : entries) {
      for (const Check& check : all) {
        if (check.kind && (!*check.kind || entry.kind == check.kind)) add(check, entry, entry.id, out);
        if (stops("creates")) break;
      }
      if (options_.only.empty() && !stops("creates")) add_drawings(entry, out);
    }
    if (wanted(kSilent)) {
      const std::string start = printed_.substr(0, 200);
      out.results.push_back({kSilent, kSilentMeaning, file,
                             printed_.empty() ? CheckOutcome::passed : CheckOutcome::failed,
                             printed_.empty() ? "" : "it wrote: " + start});
    }
    return out;
  }

 private:
  bool wanted(const char* name) const {
    // To be silent means something over all checks only.
    return options_.only.empty() || options_.only == name || options_.only == kSilent;
  }

  /// False for a manifest of effects that only edit a case.
  static bool has_code(const PluginManifest& entry) { return !entry.library.empty() || !entry.text.empty(); }

  bool check_manifest(const std::vector<PluginManifest>& entries, const std::string& file, CheckedManifest& out) {
    CheckResult result = {kManifest, kManifestMeaning, file, CheckOutcome::passed, ""};
    std::string fault;
    for (const PluginManifest& entry : entries)
      if (!entry.refused.empty() && fault.empty()) fault = entry.refused;
    if (fault.empty() && !has_code(entries.front())) {
      result.detail = "edits of a case alone, no library";
    } else if (fault.empty()) {
      try {
        LibraryFile(entries.front().text.empty() ? entries.front().library : entries.front().text);
      } catch (const Refused& refused) {
        fault = refused.reason;
      }
    }
    if (!fault.empty()) {
      result.outcome = CheckOutcome::failed;
      result.detail = fault;
    }
    if (wanted(kManifest) || result.outcome == CheckOutcome::failed) out.results.push_back(result);
    return result.outcome == CheckOutcome::passed;
  }

  void add(const Check& check, const PluginManifest& manifest, const std::string& subject, CheckedManifest& out) {
    if (!wanted(check.name)) return;
    const json answer = in_child([&] { return judge(check, manifest, options_.seed); }, !check.compiles);
    if (options_.only == kSilent) return;
    out.results.push_back({check.name, check.meaning, subject, static_cast<CheckOutcome>(answer["outcome"].get<int>()),
                           answer["detail"].get<std::string>()});
  }

  /// listens: what is written counts for the check "silent".
  json in_child(const std::function<json()>& work, bool listens = true) {
    if (options_.in_process) return work();
    const ChildOutcome child =
        run_in_child([&] { return work().dump(-1, ' ', true, json::error_handler_t::replace); }, options_.limit);
    if (listens) printed_ += child.output;
    if (child.answered()) return json::parse(child.answer);
    return outcome_of(CheckOutcome::failed, "the plugin " + child.text());
  }

  void add_drawings(const PluginManifest& manifest, CheckedManifest& out) {
    const bool law = manifest.kind == CALX_CONTACT_LAW, motion = manifest.kind == CALX_MOTION;
    if (!law && !motion && manifest.kind != CALX_GEOMETRY) return;
    const json answer = in_child([&]() -> json {
      json curves = json::array(), drawn = json::array();
      try {
        Subject subject(manifest, options_.seed);
        if (law || motion)
          for (const CheckCurve& curve : law ? law_curves(subject) : motion_curves(subject))
            curves.push_back({{"chart", curve.chart}, {"name", curve.name}, {"x", curve.x}, {"y", curve.y}});
        else
          for (const CheckShape& shape : shapes(subject))
            drawn.push_back({{"name", manifest.id + ", " + shape.name},
                             {"vertices", shape.vertices},
                             {"triangles", shape.triangles}});
      } catch (...) {  // the checks tell what is wrong
      }
      return {{"curves", curves}, {"shapes", drawn}};
    });
    if (!answer.contains("curves")) return;
    const auto numbers = [](const json& list) {
      std::vector<double> values;
      for (const json& x : list) values.push_back(x.is_number() ? x.get<double>() : 0.0);
      return values;
    };
    for (const json& curve : answer["curves"])
      out.curves.push_back({curve["chart"], curve["name"], numbers(curve["x"]), numbers(curve["y"])});
    for (const json& shape : answer["shapes"])
      out.shapes.push_back({shape["name"], numbers(shape["vertices"]), shape["triangles"]});
  }

  const CheckOptions& options_;
  std::string printed_;
};

void check_name(const std::string& only) {
  if (only.empty()) return;
  std::vector<std::string> known;
  for (const auto& check : check_names()) known.push_back(check.first);
  if (std::find(known.begin(), known.end(), only) == known.end())
    throw Error(Fault::usage, "--only " + only + ": no such check; " + did_you_mean(only, known));
}

}  // namespace

std::size_t CheckReport::count(CheckOutcome outcome) const {
  std::size_t n = 0;
  for (const CheckedManifest& manifest : manifests)
    for (const CheckResult& result : manifest.results) n += result.outcome == outcome;
  return n;
}

std::vector<std::pair<std::string, std::string>> check_names() {
  std::vector<std::pair<std::string, std::string>> out = {{kManifest, kManifestMeaning}};
  for (const Check& check : every_check()) out.emplace_back(check.name, check.meaning);
  out.emplace_back(kSilent, kSilentMeaning);
  return out;
}

CheckReport check_plugins(const std::string& path, const CheckOptions& options) {
  check_name(options.only);
  CheckReport report;
  report.seed = options.seed;
  Runner runner(options);
  for (const auto& entries : find_manifests(path)) report.manifests.push_back(runner.run(entries));
  return report;
}

CheckReport fuzz_plugins(const std::string& path, CheckOptions options, double seconds, std::uint64_t& rounds) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  check_name(options.only);
  std::set<std::string> random;
  for (const Check& check : every_check())
    if (check.random) random.insert(check.name);
  if (!options.only.empty() && !random.count(options.only))
    throw Error(Fault::usage, "--fuzz: the check " + options.only + " draws nothing at random");
  const auto manifests = find_manifests(path);
  CheckReport report;
  for (rounds = 0; rounds == 0 || std::chrono::duration<double>(Clock::now() - start).count() < seconds; ++rounds) {
    report = CheckReport();
    report.seed = options.seed;
    for (const auto& entries : manifests) {
      report.manifests.emplace_back();
      report.manifests.back().path = entries.front().path;
      for (const std::string& name : random) {
        if (!options.only.empty() && options.only != name) continue;
        CheckOptions one = options;
        one.only = name;
        const CheckedManifest checked = Runner(one).run(entries);
        auto& results = report.manifests.back().results;
        results.insert(results.end(), checked.results.begin(), checked.results.end());
      }
    }
    if (report.count(CheckOutcome::failed) > 0) break;
    ++options.seed;
  }
  return report;
}

}  // namespace calx
