// The library of a diagnosis: which effects can act, and how strong they are tried.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "io/scratch.hpp"
#include "study/candidates.hpp"

namespace calx {
namespace {

/// The library for the slot hopper at a time step.
Library library_at(const std::string& step) {
  const calx_test::Scratch scratch;
  std::ofstream(scratch / "study.json") << R"({"calx_study": 1, "cases": {"hopper": {"case": ")" << CALX_SOURCE_DIR
                                        << R"(/examples/calibration/slot_hopper.json", "set": {"/time/step": )" << step
                                        << R"(}}},
    "parameters": [{"name": "f", "range": [0.1, 0.8], "set": ["/contacts/0/parameters/friction"]}],
    "observables": [{"name": "m", "kind": "hopper-discharge", "case": "hopper", "sensor": "in hopper", "column": "mass_kg",
      "against": "time_s", "unit": "g", "at": [0.3, 0.5], "measured": {"values": [15, 12], "sd": 0.3}}]})";
  return find_library(read_study(scratch / "study.json", {CALX_PLUGIN_DIR}), 2);
}

double trial_of(const Library& library, const std::string& id) {
  const auto found = std::find_if(library.candidates.begin(), library.candidates.end(),
                                  [&](const Candidate& c) { return c.effect.id == id; });
  return found == library.candidates.end() ? 0 : 2 * found->effect.scale;
}

}  // namespace

TEST_CASE("an effect that a case refuses at its usual strength is tried weaker") {
  // The limit against the wall falls with the size of the grains: 35 us here, 14 us at 0.6 finer, 25 us at 0.3, 30 us
  // at 0.15.
  CHECK(trial_of(library_at("1e-5"), "calx.coarse-grain") == doctest::Approx(0.6));
  CHECK(trial_of(library_at("1.5e-5"), "calx.coarse-grain") == doctest::Approx(0.3));
  CHECK(trial_of(library_at("3e-5"), "calx.coarse-grain") == doctest::Approx(0.15));
}

TEST_CASE("an effect that no strength fits is left out with the reason") {
  const Library library = library_at("3.4e-5");
  CHECK(trial_of(library, "calx.coarse-grain") == 0);
  const auto found = std::find_if(library.untested.begin(), library.untested.end(),
                                  [](const Untested& u) { return u.effect == "calx.coarse-grain"; });
  REQUIRE(found != library.untested.end());
  CHECK(found->reason.find("3.4e-05 s is above the limit of") != std::string::npos);
}

}  // namespace calx
