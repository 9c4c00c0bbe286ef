// Particle scaling: what follows from the units, what a case's own numbers become, and what is refused.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.hpp"
#include "config/config.hpp"
#include "config/scale.hpp"

using namespace calx;
using doctest::Approx;

namespace {

std::string scaled_case(const std::string& scale, const std::string& sources) {
  return R"({"calx": 1, "domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "time": {"end": 1, "step": 1e-5},
    "materials": {"sand": {"density": 2000}},
    "shapes": {"pair": {"spheres": [{"at": [0, 0, -0.001], "radius": 0.002}, {"at": [0, 0, 0.001], "radius": 0.003}]}},
    "events": {"quiet": {"when": {"any": [{"settled": {"kinetic_per_particle": 1e-9}}, {"time": 3}]}}},
    "neighbour": {"skin": 1e-4}, "assumptions": ["one"], "sources": [)" +
         sources + "], " + scale + "}";
}

const char* const counted =
    R"({"name": "fill", "shape": "pair", "material": "sand", "count": 1000, "region": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}},
       {"name": "one", "shape": "pair", "material": "sand", "count": 2, "region": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}},
       {"name": "poured", "shape": "pair", "material": "sand", "mass": 0.5, "region": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}})";

std::string message_of(const std::string& text) {
  try {
    parse_case(text, "case.json");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::settings);
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a parameter follows by its unit: mass by the cube, length and time by the factor") {
  const ScaleSettings strength{3, ScaleSettings::Cohesion::strength}, bond{3, ScaleSettings::Cohesion::bond};
  const struct {
    const char* unit;
    double strength, bond;
  } rows[] = {{"1", 1, 1},
              {"Pa", 1, 1},
              {"kg/m^3", 1, 1},
              {"m/s", 1, 1},
              {"N/m", 3, 3},
              {"m", 3, 3},
              {"s", 3, 3},
              {"1/s", 1.0 / 3, 1.0 / 3},
              {"kg/s", 9, 9},
              {"N", 9, 27},
              {"J/m^2", 3, 9},
              {"N/m^1.5", std::sqrt(3.0), std::sqrt(3.0)},
              {"kg", 27, 27},
              {"J", 27, 27},
              {"N/m^2.5", 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}};
  for (const auto& row : rows) {
    INFO(row.unit);
    CHECK(scale_factor(strength, row.unit) == Approx(row.strength).epsilon(1e-14));
    CHECK(scale_factor(bond, row.unit) == Approx(row.bond).epsilon(1e-14));
  }
}

TEST_CASE("shapes, counts, the given step, the skin and energies of conditions follow; masses and vessels stay") {
  const CaseSettings c = parse_case(scaled_case(R"("scale": {"factor": 2})", counted), "case.json").settings;
  CHECK(c.scale.cohesion == ScaleSettings::Cohesion::strength);
  CHECK(c.shapes[0].spheres[0].at.z == -0.002);
  CHECK(c.shapes[0].spheres[1].radius == 0.006);
  CHECK(c.sources[0].count == 125);
  CHECK(c.sources[1].count == 1);
  CHECK(c.sources[2].mass == 0.5);
  CHECK(c.time.step == 2e-5);
  CHECK(c.neighbour.skin == 2e-4);
  CHECK(c.events[0].when.parts[0].kinetic_per_particle == Approx(8e-9));
  CHECK(c.domain.box.hi.x == 1);
  REQUIRE(c.assumptions.size() == 2);
  CHECK(c.assumptions[1].find("grains 2 times the size that the case draws") != std::string::npos);
}

TEST_CASE("the resolved case scales to the same settings again, not twice") {
  const CaseFile once = parse_case(scaled_case(R"("scale": {"factor": 2, "cohesion": "bond"})", counted), "case.json");
  const CaseSettings again = parse_case(once.resolved, "case.json").settings;
  CHECK(again.shapes[0].spheres[1].radius == 0.006);
  CHECK(again.sources[0].count == 125);
  CHECK(again.assumptions == once.settings.assumptions);
  CHECK(again.scale.cohesion == ScaleSettings::Cohesion::bond);
}

TEST_CASE("bad scales are named") {
  CHECK(message_of(scaled_case(R"("scale": {})", counted)) ==
        "case.json /scale/factor: is missing; how many times larger the grains are, such as 2");
  CHECK(message_of(scaled_case(R"("scale": {"factor": 0})", counted)) ==
        "case.json /scale/factor: 0 is out of range; must be above 0");
  CHECK(message_of(scaled_case(R"("scale": {"factor": 200})", counted)) ==
        "case.json /scale/factor: 200 is out of range; must be from 0.01 to 100");
  CHECK(message_of(scaled_case(R"("scale": {"factor": 2, "cohesion": "bnd"})", counted)) ==
        "case.json /scale/cohesion: \"bnd\" is not a way to scale cohesion; did you mean \"bond\"?");
  CHECK(message_of(scaled_case(R"("scale": {"factor": 2, "facter": 3})", counted)) ==
        "case.json /scale/facter: unknown key; did you mean \"factor\"?");
  const char* const placed =
      R"({"name": "placed", "shape": "pair", "material": "sand", "positions": [[0.5, 0.5, 0.5]]})";
  CHECK(message_of(scaled_case(R"("scale": {"factor": 2})", placed)) ==
        "case.json /sources/0/positions: source \"placed\" gives each grain its place, which grains of another size "
        "cannot "
        "take; let it fill a region, or leave \"scale\" out");
  CHECK(message_of(scaled_case(R"("scale": {"factor": 1})", placed)) == "no error");
}
