// Several laws on one contact.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/case.hpp"

using namespace calx;

namespace {

const char* const kHertz = R"("law": "calx.hertz-mindlin", "parameters": {"restitution": 0.5, "friction": 0.4,
  "rolling": "epsd2", "rolling_friction": 0.1})";

std::string linear(double share, const std::string& name, double friction = 0.4) {
  return "\"law\": \"calx.linear\", \"name\": \"" + name +
         "\", \"parameters\": {\"kn\": " + std::to_string(share * 8000) +
         ", \"restitution\": 1, \"damping\": " + std::to_string(share * 0.02) +
         ", \"friction\": " + std::to_string(friction) + "}";
}

const char* const kTwo =
    R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25}, "iron": {"density": 7000, "young": 2e7, "poisson": 0.3}})";

/// Clumps and walls of two materials, so that blocks of every pair occur.
CaseFile scene(const std::string& laws) {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.materials = kTwo;
  c.contacts = "[";
  for (const char* pair : {R"(["sand", "sand"])", R"(["sand", "iron"])", R"(["iron", "iron"])"})
    c.contacts += std::string(c.contacts.size() > 1 ? "," : "") + "{\"between\": " + pair + ", " + laws + "}";
  c.contacts += "]";
  c.time = R"({"step": 5e-6, "end": 10})";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "iron",
                 "parameters": {"min": [0, 0, 0], "max": [0.03, 0.03, 0.1]}}])";
  auto particles = lattice(500, 10, 10, 2.8e-3, {1e-3, 1e-3, 2e-4}, 5e-5, 0.5);
  CaseFile file = with_given(c, "grain", {particles.begin(), particles.begin() + 300});
  file.settings.sources.push_back(given_source("grain", {particles.begin() + 300, particles.end()}, "iron"));
  return file;
}

}  // namespace

TEST_CASE("a list of one law equals the law alone to the bit") {
  Simulation alone(scene(kHertz), test_options()),
      list(scene(std::string("\"laws\": [{") + kHertz + "}]"), test_options());
  advance(alone, 250);
  advance(list, 250);
  CHECK(alone.counters().touching > 20);
  CHECK(alone.digest() == list.digest());
}

TEST_CASE("a second law without strength leaves every position and velocity to the bit") {
  const std::string nothing =
      R"({"law": "calx.linear", "parameters": {"kn": 1e-300, "restitution": 1, "friction": 0}})";
  Simulation alone(scene(kHertz), test_options()),
      first(scene(std::string("\"laws\": [{") + kHertz + "}, " + nothing + "]"), test_options()),
      second(scene(std::string("\"laws\": [") + nothing + ", {" + kHertz + "}]"), test_options());
  advance(alone, 250);
  advance(first, 250);
  advance(second, 250);
  const auto in_alone = ranks_by_id(alone), in_first = ranks_by_id(first), in_second = ranks_by_id(second);
  for (std::uint32_t id = 0; id < 500; ++id) {
    const Record& a = alone.world().particles().body[in_alone.at(id)];
    for (const Record* other :
         {&first.world().particles().body[in_first.at(id)], &second.world().particles().body[in_second.at(id)]}) {
      const Record& b = *other;
      CHECK(norm(position(a) - position(b)) == 0);
      CHECK(norm(velocity(a) - velocity(b)) == 0);
      CHECK(norm(spin(a) - spin(b)) == 0);
    }
  }
}

TEST_CASE("two laws of half strength equal one to rounding") {
  Simulation whole(scene(linear(1, "whole")), test_options()),
      halves(scene("\"laws\": [{" + linear(0.5, "a") + "}, {" + linear(0.5, "b") + "}]"), test_options());
  advance(whole, 250);
  advance(halves, 250);
  CHECK(whole.counters().touching > 20);
  double x_off = 0, v_off = 0;
  for (std::uint32_t id = 0; id < 500; ++id) {
    x_off = std::max(x_off, norm(position(body_of(whole, id)) - position(body_of(halves, id))));
    v_off = std::max(v_off, norm(velocity(body_of(whole, id)) - velocity(body_of(halves, id))));
  }
  CHECK(x_off < 1e-12);
  CHECK(v_off < 1e-9);
}

TEST_CASE("forces of different laws add: a spring beside a spring is a stiffer spring") {
  // Head-on impact of two equal spheres, no loss: contact time pi sqrt(m* / k).
  auto largest = [](const std::string& laws) {
    CaseText c;
    c.contacts = R"([{"between": ["sand", "sand"], )" + laws + "}]";
    c.time = R"({"step": 5e-7, "end": 10})";
    Simulation sim(with_given(c, "ball", {{{0, 0, 0}, {0.5, 0, 0}, {}, {}}, {{0.0021, 0, 0}, {-0.5, 0, 0}, {}, {}}}),
                   test_options());
    advance(sim, 2000);
    CHECK(body_of(sim, 0).vx == doctest::Approx(-0.5).epsilon(2e-3));
    return sim.counters().largest_overlap * 1e-3;
  };
  auto spring = [](int k, const std::string& name) {
    return "\"law\": \"calx.linear\", \"name\": \"" + name + "\", \"parameters\": {\"kn\": " + std::to_string(k) +
           ", \"restitution\": 1, \"friction\": 0}";
  };
  const double m = 2000 * 4.0 / 3 * 3.14159265358979 * 1e-9;
  // delta_max = v sqrt(m* / k), v = 1 m/s.
  CHECK(largest(spring(1000, "a")) == doctest::Approx(std::sqrt(0.5 * m / 1000)).scale(0).epsilon(1e-3));
  CHECK(largest("\"laws\": [{" + spring(1000, "a") + "}, {" + spring(3000, "b") + "}]") ==
        doctest::Approx(std::sqrt(0.5 * m / 4000)).scale(0).epsilon(1e-3));
}

TEST_CASE("laws of one list keep their histories apart over list rebuilds") {
  // Rolling columns of one law beside plastic columns of another, in both orders.
  const std::string epam =
      R"({"law": "calx.epam", "parameters": {"restitution": 0.4, "friction": 0.2, "plasticity": 0.4,
    "surface_energy": 0.2}})";
  Simulation ab(scene(std::string("\"laws\": [{") + kHertz + "}, " + epam + "]"), test_options()),
      ba(scene(std::string("\"laws\": [") + epam + ", {" + kHertz + "}]"), test_options());
  advance(ab, 250);
  advance(ba, 250);
  CHECK(ab.counters().rebuilds > 3);
  double off = 0;
  for (std::uint32_t id = 0; id < 500; ++id)
    off = std::max(off, norm(velocity(body_of(ab, id)) - velocity(body_of(ba, id))));
  CHECK(off < 1e-9);
}

TEST_CASE("each pair of materials has its own law, whatever the others keep as history") {
  CaseFile file = scene(kHertz);
  CaseText c;
  c.materials = kTwo;
  // Powder on powder keeps an overlap first, powder on iron a tangential spring.
  c.contacts = R"([{"between": ["sand", "sand"], "law": "calx.epam",
                    "parameters": {"restitution": 0.5, "friction": 0.4, "plasticity": 0.3}},
                   {"between": ["sand", "iron"], )" +
               std::string(kHertz) + R"(}, {"between": ["iron", "iron"], )" + kHertz + "}]";
  file.settings.contacts = c.file().settings.contacts;
  file.settings.energy_ledger = true;
  Simulation sim(file, test_options());
  auto account = [&sim] {
    const auto e = sim.world().energy();
    const double lost = e.friction + e.damping + e.plastic;
    return std::make_pair(e.kinetic_translation + e.kinetic_rotation + e.gravity + e.elastic + lost, lost);
  };
  advance(sim, 1);
  const double start = account().first;
  advance(sim, 3000);
  CHECK(sim.counters().rebuilds > 10);
  CHECK(sim.world().energy().plastic > 0);
  const double missing = account().first - start;
  MESSAGE("lost " << account().second << " J, missing " << missing << " J");
  // Springs turned round the wrong way would put energy in.
  CHECK(std::fabs(missing) < 0.01 * account().second);
}
