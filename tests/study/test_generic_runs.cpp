// Generic terms at work: closed forms of each target in runs of a few balls, and no trace at amount 0.
#include <doctest/doctest.h>

#include <cmath>

#include "io/scratch.hpp"
#include "study/generic_terms.hpp"
#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

/// Balls of "sand", a floor of "steel" that has no friction by itself, and one generic term.
struct World {
  calx_test::Scratch scratch;
  CaseText text;
  World(const std::string& target, const std::string& formula) {
    Study study;
    study.file = "study.json", study.folder = "/";
    study.generic_terms =
        R"([{"name": "term", "on": ")" + target + R"(", "formula": ")" + formula + R"(", "scale": 1}])";
    write_generic_plugins(scratch / "generic", read_generic_terms(study));
    text.materials = R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25},
                         "steel": {"density": 7800, "young": 1e9, "poisson": 0.3}})";
  }
  /// extra: the amount of the term, at `between`, or as a force; empty: without the term.
  Simulation run(const std::string& between, const std::string& amount, const std::vector<Given>& balls) {
    const std::string law = R"({"law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0}})";
    const std::string more =
        amount.empty() ? "" : R"(, {"law": "generic.term", "parameters": {"amount": )" + amount + "}}";
    const auto laws = [&](const std::string& other) {
      return R"({"between": ["sand", ")" + other + R"("], "laws": [)" + law + (between == other ? more : "") + "]}";
    };
    text.contacts = "[" + laws("sand") + ", " + laws("steel") + "]";
    text.more = between == "force" && !amount.empty()
                    ? R"("forces": [{"plugin": "generic.term", "parameters": {"amount": )" + amount + "}}]"
                    : "";
    SimulationOptions options = test_options();
    options.plugin_path.push_back(scratch / "generic");
    return Simulation(with_given(text, "ball", balls), options);
  }
};

const char* const floor_below =
    R"([{"name": "floor", "geometry": "calx.plane", "material": "steel", "parameters": {"half_u": 1, "half_v": 1}}])";

}  // namespace

TEST_CASE("drag slows a ball as an exponential of time") {
  World world("drag", "1 + 0 * x");
  Simulation sim = world.run("force", "2", {{{}, {1, 0, 0}, {}, {}}});
  advance(sim, 20000);
  // Euler's step of 1e-5 s errs by half of 2e-5 times the exponent.
  CHECK(velocity(body_of(sim, 0)).x == near(std::exp(-2 * 0.2), 1e-4));
}

TEST_CASE("friction on walls adds to that of the case") {
  World world("wall friction", "speed / speed");
  world.text.gravity = "[0, 0, -9.81]";
  world.text.parts = floor_below;
  // Lying at the overlap that carries its weight: no bounce.
  Simulation rest = world.run("steel", "", {{{0, 0, 0.000999}, {}, {}, {}}});
  advance(rest, 30000);
  const double height = body_of(rest, 0).z;
  Simulation sim = world.run("steel", "0.2", {{{0, 0, height}, {1, 0, 0}, {}, {}}});
  advance(sim, 5000);
  CHECK(velocity(body_of(sim, 0)).x == near(1 - 0.2 * 9.81 * 0.05, 1e-3));
  // What slides on a frictionless floor else.
  CHECK(velocity(body_of(rest, 0)).x == 0);
}

TEST_CASE("walls pull with so many weights of the grain") {
  World world("wall pull", "1");
  world.text.gravity = "[0, 0, 9.81]";  // away from the floor
  world.text.parts = floor_below;
  for (const bool enough : {true, false}) {
    Simulation sim = world.run("steel", enough ? "1.2" : "0.8", {{{0, 0, 0.000999999}, {}, {}, {}}});
    advance(sim, 10000);
    CHECK((body_of(sim, 0).z < 0.001) == enough);
  }
}

TEST_CASE("grains that touch pull each other, and what acts later acts later") {
  for (const bool late : {false, true}) {
    World world("grain pull", late ? "max(0, time - 1000)" : "1");
    Simulation sim = world.run(
        "sand", "2", {{{-0.0009999, 0, 0}, {-0.001, 0, 0}, {}, {}}, {{0.0009999, 0, 0}, {0.001, 0, 0}, {}, {}}});
    advance(sim, 3000);
    const double apart = body_of(sim, 1).x - body_of(sim, 0).x;
    CHECK((apart < 0.002) == !late);
  }
}

TEST_CASE("at amount 0 the bits of a run stay as they are") {
  const std::vector<Given> balls = {{{0, 0, 0.001}, {0.1, 0, 0}, {}, {}}, {{0.0012, 0, 0.0026}, {}, {0, 30, 0}, {}}};
  for (const GenericTerm& term : usual_generic_terms()) {
    World world(term.target, term.formula);
    world.text.gravity = "[0, 0, -9.81]";
    world.text.parts = floor_below;
    const std::string between = term.target == "drag" ? "force" : term.target.find("wall") == 0 ? "steel" : "sand";
    Simulation with = world.run(between, "0", balls), without = world.run(between, "", balls);
    advance(with, 2000), advance(without, 2000);
    for (const std::uint32_t k : {0u, 1u}) {
      const Record &a = body_of(with, k), &b = body_of(without, k);
      CHECK_MESSAGE((a.x == b.x && a.y == b.y && a.z == b.z), term.name);
      CHECK_MESSAGE(norm(velocity(a) - velocity(b)) == 0, term.name);
    }
  }
}
