// conformance.hpp: the tools of a plugin author. check: does a plugin keep what the ABI promises, check by check, each
// in a child process. doctor: why is it refused, and what helps. new: a project to start from.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace calx {

enum class CheckOutcome { passed, failed, skipped };

struct CheckResult {
  std::string name;     // kebab-case, kept for ever
  std::string meaning;  // one sentence
  std::string subject;  // plugin id, or the file's name for checks of the whole library
  CheckOutcome outcome = CheckOutcome::passed;
  std::string detail;  // what was found, or why it was skipped
};

/// A curve of a contact law or a motion, for the page.
struct CheckCurve {
  std::string chart, name;  // chart: "normal", "restitution", "tangential"; "shift", "turn"
  std::vector<double> x, y;
};

/// The shape of a geometry, for the page; part frame, m.
struct CheckShape {
  std::string name;
  std::vector<double> vertices;          // x, y, z of each
  std::vector<std::uint32_t> triangles;  // three vertex numbers each
};

struct CheckedManifest {
  std::string path;  // of the manifest
  std::vector<CheckResult> results;
  std::vector<CheckCurve> curves;
  std::vector<CheckShape> shapes;
};

struct CheckOptions {
  std::string only;         // the name of one check; empty: all
  bool in_process = false;  // no child process, for debuggers: a crash ends the program
  std::uint64_t seed = 1;   // of all random inputs
  double limit = 60;        // wall time of one check, s
};

struct CheckReport {
  std::uint64_t seed = 1;
  std::vector<CheckedManifest> manifests;
  std::size_t count(CheckOutcome outcome) const;
};

/// path: a manifest, a folder of manifests, or a library with its manifest beside it. Throws Error(Fault::files) for a
/// path that is none of them, Error(Fault::usage) for a check that is not known.
CheckReport check_plugins(const std::string& path, const CheckOptions& options = {});
/// Random checks again and again with rising seeds, until one fails or the time, s, is over. The report is that of the
/// last round; rounds: how many there were.
CheckReport fuzz_plugins(const std::string& path, CheckOptions options, double seconds, std::uint64_t& rounds);

/// Every check with its meaning, in the order they run.
std::vector<std::pair<std::string, std::string>> check_names();

std::string check_text(const CheckReport& report, bool all);  // all: passed ones, too
std::string check_json(const CheckReport& report);
/// A page of its own, without outside references.
void write_check_page(const CheckReport& report, const std::string& file);

/// Why the plugins below path are refused, in plain words, each with what helps; and a sentence for those that are not.
/// all_well: nothing was refused. path as for check_plugins; a file that has no manifest is explained, too.
std::string plugin_doctor_text(const std::string& path, bool& all_well);

/// Writes a project into folder/NAME, from the templates installed with Calx. kind: one of new_plugin_kinds. Returns
/// the files written. Throws Error(Fault::usage) for a name or kind that cannot be, Error(Fault::files) where something
/// of that name is there already or the templates are missing.
std::vector<std::string> new_plugin(const std::string& name, const std::string& kind, const std::string& folder);
/// The commands that build, check and run such a project, for people.
std::string new_plugin_advice(const std::string& name, const std::string& kind, const std::string& folder);
/// Kinds of new_plugin: those of the ABI, and a law that is a text alone.
std::vector<std::string> new_plugin_kinds();

}  // namespace calx
