// Runs in processes of their own: what one that its case refuses means for the others.
#include <doctest/doctest.h>

#include "base/error.hpp"
#include "io/scratch.hpp"
#include "study/executor.hpp"

namespace calx {
namespace {

/// The slot hopper for 0.02 s, filled with so many kg; its source has room for some 20 g.
RunRequest filled_with(const std::string& mass, bool may_be_refused) {
  RunRequest out;
  out.case_path = CALX_SOURCE_DIR "/examples/calibration/slot_hopper.json";
  out.overrides = {{"/sources/0/mass", mass}, {"/time/end", "0.02"}};
  out.may_be_refused = may_be_refused;
  return out;
}

std::vector<RunResult> runs(const std::vector<RunRequest>& requests) {
  const calx_test::Scratch scratch;
  ExecutorSettings settings;
  settings.cache = scratch / "runs";
  settings.program = CALX_BINARY;
  settings.plugin_path = {CALX_PLUGIN_DIR};
  settings.jobs = 1;
  return make_executor(settings)->run(requests, {});
}

}  // namespace

TEST_CASE("a case that cannot run ends the batch, unless it may be refused") {
  CHECK_THROWS_WITH_AS(runs({filled_with("0.5", false)}), doctest::Contains("the region cannot hold 0.5 kg"), Error);
  const std::vector<RunResult> results = runs({filled_with("0.5", true), filled_with("0.001", false)});
  CHECK(results[0].folder.empty());
  CHECK(results[0].error.find("the region cannot hold 0.5 kg") != std::string::npos);
  CHECK(results[1].error.empty());
  CHECK_FALSE(results[1].folder.empty());
}

}  // namespace calx
