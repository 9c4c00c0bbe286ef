// Each plugin of tests/bad_plugins that misbehaves once it runs is found by the check meant for it, and says why.
#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.hpp"
#include "conformance/conformance.hpp"

using namespace calx;

namespace {

/// Failed checks of a bad plugin as "name: detail", one a line.
std::string failures(const std::string& name, const std::string& only, double limit = 60) {
  CheckOptions options;
  options.only = only;
  options.limit = limit;
  const CheckReport report = check_plugins(std::string(CALX_BAD_PLUGIN_DIR) + "/" + name, options);
  std::string out;
  for (const CheckedManifest& manifest : report.manifests)
    for (const CheckResult& result : manifest.results)
      if (result.outcome == CheckOutcome::failed) out += result.name + ": " + result.detail + "\n";
  return out;
}

struct Expected {
  const char* plugin;
  const char* check;
  const char* words;
};

void expect(const Expected& one, double limit = 60) {
  CAPTURE(std::string(one.plugin));
  const std::string text = failures(one.plugin, one.check, limit);
  CAPTURE(text);
  CHECK(text.find(std::string(one.check) + ": ") != std::string::npos);
  CHECK(text.find(one.words) != std::string::npos);
}

}  // namespace

TEST_CASE("the good plugin and the good law pass every check") {
  CHECK(failures("good", "") == "");
  CHECK(failures("good_law", "") == "");
  CHECK(failures("counts", "nested-init") == "");
}

TEST_CASE("libraries that cannot be used fail to load, each with its reason") {
  for (const Expected& one : {
           Expected{"wrong_magic", "loads", "begins with 0x12345678"},
           {"other_major", "loads", "built for ABI 2.0"},
           {"small_struct", "loads", "has 24 bytes"},
           {"null_factory", "loads", "has no factory"},
           {"missing_symbol", "loads", "exports no calx_plugin_entry"},
           {"init_fails", "loads", "no calibration file"},
           {"needs_extension", "loads", "calx.host.query/1"},
           {"changes_rounding", "loads", "changed the floating-point mode"},
           {"needs_host_symbols", "loads", "undefined symbol: calx_internal_function"},
           {"lying_manifest", "loads", "manifest"},
           {"crashes_in_init", "loads", "crashed with SIGSEGV"},
       })
    expect(one);
  expect({"hangs_in_init", "loads", "did not come back within 2 s"}, 2);
}

TEST_CASE("plugins that make no usable instance are told apart") {
  for (const Expected& one : {
           Expected{"wrong_draft", "tables", "built against draft 7"},
           {"small_table", "tables", "has 8 bytes"},
           {"null_table", "tables", "has no table"},
           {"null_eval", "tables", "lacks eval"},
           {"other_hash", "tables", "SHA-256"},
           {"create_fails", "creates", "out of memory"},
           {"create_nothing", "creates", "made no instance"},
           {"changes_rounding_in_create", "creates", "changed the floating-point mode"},
           {"crashes_in_create", "creates", "crashed with SIGSEGV"},
           {"exits_in_create", "creates", "ended the process with exit status 0"},
           {"throws_across", "creates", "crashed with SIGABRT"},
           {"counts_wrong", "nested-init", "created before it was initialised"},
           {"answers_any_id", "unknown-ids", "compare the whole id"},
           {"exports_more", "one-symbol", "bad_helper"},
       })
    expect(one);
}

TEST_CASE("what a force does wrong when it runs is found") {
  for (const Expected& one : {
           Expected{"not_finite", "force-finite", "not finite at a speed of 0 m/s"},
           {"writes_past_the_block", "force-blocks", "wrote outside of the 100 rows"},
           {"replaces_forces", "force-blocks", "it replaced it"},
           {"fixed_direction", "force-rotation", "CALX_VEC"},
           {"changes_rounding_in_eval", "fp-environment", "changed the floating-point mode"},
           {"aborts_in_eval", "force-finite", "crashed with SIGABRT"},
           {"exits_in_eval", "force-finite", "ended the process with exit status 0"},
           {"prints", "silent", "working on "},
       })
    expect(one);
}

TEST_CASE("what a law does wrong is found") {
  for (const Expected& one : {
           Expected{"text_differs", "text-host", "natively and"},
           {"leaning_text", "text-host", "LEANING_TEXT_STIFFER"},
           {"leaning_text", "text-dialect", "LEANING_TEXT_STIFFER"},
           {"asymmetric", "swap", "trading i and j"},
           {"creates_energy", "energy", "more energy than was put in"},
           {"pulls", "pushes", "n points from j to i and out is the force on i"},
           {"drives", "energy", "a dashpot takes energy where its force is -gn * vn"},
           {"drives", "stable-step", "not the step, the law creates energy"},
           {"writes_past_the_rows", "blocks", "wrote outside of the "},
           {"too_long_a_step", "stable-step", "times the speed they met with"},
           {"too_short_a_reach", "reach", "a wrench beyond its reach of 1e-05 m"},
           {"remembers_outside", "blocks", "other bits"},
           {"reads_what_it_did_not_ask_for", "finite", "crashed with SIGSEGV"},
       })
    expect(one);
  // A compiler that complains of its text is not the plugin.
  CHECK(failures("leaning_text", "silent") == "");
  expect({"never_returns", "finite", "did not come back within 3 s"}, 3);
}

TEST_CASE("motions, shapes and hidden state that break their promise are found") {
  for (const Expected& one : {
           Expected{"wrong_velocity", "velocity", "velocity and spin of the pose say 0.5 m/s"},
           {"wrong_sign", "velocity", "apart, in the opposite direction: has velocity or spin the wrong sign?"},
           {"open_mesh", "shape-mesh", "the surface is open, with 4 open edges"},
           {"halfway", "shape-mesh", "at 1 place (first at (0, 0.5, 0) m) a corner lies halfway on an edge"},
           {"open_mesh", "shape-mesh", "surface"},
           {"forgets_state", "state", "a part of the state is not saved"},
       })
    expect(one);
  // Only the one that forgets.
  const std::string state = failures("forgets_state", "state");
  CHECK(std::count(state.begin(), state.end(), '\n') == 1);
}

TEST_CASE("a plugin that calls itself by another's id passes on its own; the listing reports both") {
  CHECK(failures("steals_a_name", "loads") == "");
}
