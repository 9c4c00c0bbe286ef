// What stops a run, and what the message says; what happens to particles that leave.
#include <doctest/doctest.h>

#include <cmath>
#include <regex>

#include "base/error.hpp"
#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

CaseText small_domain(const std::string& on_leave) {
  CaseText c;
  c.domain = R"({"min": [-0.01, -0.01, -0.01], "max": [0.01, 0.01, 0.01], "on_leave": ")" + on_leave + "\"}";
  c.more = "\"energy\": true";
  return c;
}

const std::vector<Given> kLeavers{{{0, 0, 0}, {0.1, 0, 0}, {}, {}},
                                  {{0.009, 0, 0}, {2, 0, 0}, {}, {}},
                                  {{0, 0.008, 0.005}, {0, 3, 0}, {50, 0, 0}, {}}};

/// Steps until an error; its text.
std::string failure(Simulation& sim, int steps) {
  try {
    advance(sim, steps);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a particle that leaves stops the run by default, named with place and velocity") {
  for (const char* integrator : {"euler", "verlet"}) {
    CaseText c = small_domain("error");
    c.time = R"({"integrator": ")" + std::string(integrator) + R"(", "step": 1e-5, "end": 10})";
    Simulation sim(with_given(c, "ball", kLeavers), test_options());
    const std::string text = failure(sim, 1000);
    CHECK(text.find("run stopped at t = 0.0005") == 0);
    CHECK(text.find("particle 1 left the domain at (0.01") != std::string::npos);
    CHECK(text.find("velocity (2, 0, 0) m/s") != std::string::npos);
    // No number of more than six digits.
    CHECK_FALSE(std::regex_search(text, std::regex("\\.0*[1-9][0-9]{6}|[1-9]\\.[0-9]{6}")));
    CHECK(text.find("\"on_leave\"") != std::string::npos);
  }
}

TEST_CASE("particles that leave are deleted and counted in the ledgers") {
  for (const char* mode : {"delete", "count"})
    for (const char* shape : {"ball", "odd"}) {
      Simulation sim(with_given(small_domain(mode), shape, kLeavers), test_options());
      advance(sim, 800);
      const auto l = sim.world().mass();
      CHECK(sim.world().particles().count() == 1);
      CHECK(sim.world().particles().id[0] == 0);
      CHECK(l.removed_count == 2);
      CHECK(l.inserted_count == l.inside_count + l.removed_count);
      CHECK(l.inserted == near(l.inside + l.removed, 1e-14));
      const auto e = sim.world().energy();
      CHECK(e.removed > 0.9 * e.inserted);
      CHECK(std::fabs(e.remainder) < 1e-9 * e.inserted);
    }
}

TEST_CASE("an overlap beyond the limit stops the run and names both") {
  CaseText c;
  c.materials = R"({"sand": {"density": 2000, "young": 1e4, "poisson": 0.25}})";
  Simulation pair(with_given(c, "ball", {{{0, 0, 0}, {}, {}, {}}, {{0.00205, 0, 0}, {-20, 0, 0}, {}, {}}}),
                  test_options());
  const std::string text = failure(pair, 1000);
  CHECK(text.find("run stopped at t = ") == 0);
  CHECK(text.find("of the radius at (") != std::string::npos);
  CHECK(text.find("particle 0 with particle 1") != std::string::npos);
  CHECK(text.find("the limit is 0.5 (\"overlap_limit\")") != std::string::npos);
  c.parts = R"([{"name": "left", "geometry": "calx.plane", "material": "sand", "parameters": {"point": [0, 0, 0.5]}},
                {"name": "plate", "geometry": "calx.plane", "material": "sand"}])";
  Simulation wall(with_given(c, "ball", {{{0, 0, 0.0011}, {0, 0, -20}, {}, {}}}), test_options());
  const std::string second = failure(wall, 1000);
  CHECK(second.find("particle 0 with part \"plate\"") != std::string::npos);
  c.more = "\"overlap_limit\": 1.1";
  Simulation wide(with_given(c, "ball", {{{0, 0, 0.0011}, {0, 0, -9}, {}, {}}}), test_options());
  CHECK(failure(wide, 500) == "no error");
  CHECK(wide.counters().largest_overlap > 0.5);
}

TEST_CASE("a number that is not finite stops the run and names the particle") {
  for (const char* integrator : {"euler", "verlet"})
    for (const char* shape : {"ball", "odd"}) {
      CaseText c;
      c.time = R"({"integrator": ")" + std::string(integrator) + R"(", "step": 1e-5, "end": 10})";
      c.materials = R"({"sand": {"density": 2000}})";
      c.contacts = "[]";
      Simulation sim(with_given(c, shape, {{{0, 0, 0}, {}, {}, {}}, {{0.1, 0, 0}, {1e200, 0, 0}, {}, {}}}),
                     test_options());
      const std::string text = failure(sim, 10);
      CAPTURE(text);
      CHECK(text.find("non-finite motion of particle 1: position x, velocity x") != std::string::npos);
      CHECK(text.find("nan") == std::string::npos);
      CHECK(text.find("time step is too large") != std::string::npos);
    }
}

TEST_CASE("two materials without a law stop the run only when they touch, by name") {
  CaseText c;
  c.materials =
      R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}, "iron": {"density": 7000, "young": 1e7, "poisson": 0.25}})";
  CaseFile file = with_given(c, "ball", {{{0, 0, 0}, {}, {}, {}}});
  file.settings.sources.push_back(given_source("ball", {{{0.003, 0, 0}, {-1, 0, 0}, {}, {}}}, "iron"));
  Simulation sim(file, test_options());
  advance(sim, 50);
  const std::string text = failure(sim, 100);
  CHECK(text.find("/contacts: particles of \"sand\" touch \"iron\" but no law is given between them") !=
        std::string::npos);
  CHECK(text.find("{\"between\": [\"sand\", \"iron\"], \"law\": ...}") != std::string::npos);
  c.parts =
      R"([{"name": "plate", "geometry": "calx.plane", "material": "iron", "parameters": {"point": [0, 0, -0.0012]}}])";
  Simulation wall(with_given(c, "ball", {{{0, 0, 0}, {0, 0, -1}, {}, {}}}), test_options());
  CHECK(failure(wall, 100).find("\"sand\" touch \"iron\"") != std::string::npos);
}

TEST_CASE("a law that is not there is refused with the nearest name") {
  CaseText c;
  c.contacts = R"([{"between": ["sand", "sand"], "law": "calx.hertz-midlin", "parameters": {}}])";
  CHECK_THROWS_WITH_AS(Simulation(c.file(), test_options()), doctest::Contains("calx.hertz-mindlin"), Error);
}
