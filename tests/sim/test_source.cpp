// Sources: amounts, rates, sizes, free places, and what is refused.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/error.hpp"
#include "neighbour/pair_list.hpp"
#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

CaseText with_source(const std::string& source) {
  CaseText c;
  c.sources = "[" + source + "]";
  return c;
}

/// Balls as a CSV file gives them.
CaseText with_balls_of(const std::string& path) {
  return with_source(R"({"name": "f", "shape": "ball", "material": "sand", "file": ")" + path + "\"}");
}

/// Largest overlap of two spheres of different particles over the smaller radius; periodic: of the box.
double worst_overlap(const Simulation& sim, const Wrap& wrap = {}) {
  const Particles& p = sim.world().particles();
  const Record* s = p.spheres();
  double worst = 0;
  for (std::size_t i = 0; i < p.sphere_count(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (p.owner_of(i) != p.owner_of(j))
        worst = std::max(
            worst, (s[i].r + s[j].r - norm(wrap.nearest(position(s[i]) - position(s[j])))) / std::min(s[i].r, s[j].r));
  return worst;
}

struct TemporaryFile {
  explicit TemporaryFile(const std::string& text)
      : path(std::filesystem::temp_directory_path() / ("calx_seeds_" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(path) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

}  // namespace

TEST_CASE("a fill delivers the mass asked for within one particle, inside its region, without overlaps") {
  for (const char* size : {R"({"scale": 1})", R"({"distribution": "normal", "mean": 1, "deviation": 0.1})",
                           R"({"distribution": "lognormal", "median": 1, "deviation": 0.1})",
                           R"({"distribution": "uniform", "lowest": 0.6, "highest": 1.2})"})
    for (const char* region : {R"({"box": {"min": [0, 0, 0], "max": [0.04, 0.03, 0.05]}})",
                               R"({"cylinder": {"from": [0, 0, 0], "to": [0.02, 0, 0.05], "radius": 0.025}})",
                               R"({"sphere": {"centre": [0, 0, 0], "radius": 0.028}})"}) {
      CaseText c =
          with_source(std::string(R"({"name": "fill", "shape": "grain", "material": "sand", "mass": 0.004, "size": )") +
                      size + ", \"region\": " + region + "}");
      c.time = R"({"step": 1e-6, "end": 1})";
      CaseFile file = c.file();
      Simulation sim(file, test_options());
      sim.step();
      const Particles& p = sim.world().particles();
      double heaviest = 0, mass = 0;
      for (std::size_t k = 0; k < p.count(); ++k) {
        mass += p.mass(k);
        heaviest = std::max(heaviest, p.mass(k));
        CHECK(file.settings.sources[0].region.contains(position(p.body[k])));
      }
      CHECK(std::fabs(mass - 0.004) <= heaviest);
      CHECK(sim.world().mass().requested == 0.004);
      CHECK(sim.world().mass().delivered == near(mass, 1e-12));
      CHECK(worst_overlap(sim) <= 0);
      const auto said = sim.take_messages();
      REQUIRE(said.size() == 1);
      CHECK(said[0].find("source \"fill\" has delivered") != std::string::npos);
    }
}

TEST_CASE("a count is delivered exactly, with the velocity asked for and turned at random") {
  Simulation sim(with_source(R"({"name": "a", "shape": "odd", "material": "sand", "count": 77, "velocity": [1, 2, 3],
    "region": {"box": {"min": [0, 0, 0], "max": [0.03, 0.03, 0.03]}}})")
                     .file(),
                 test_options());
  sim.step();
  const Particles& p = sim.world().particles();
  CHECK(p.count() == 77);
  Vec3 mean;
  for (std::size_t k = 0; k < p.count(); ++k) {
    CHECK(norm(velocity(p.body[k]) - Vec3{1, 2, 3}) < 1e-14);
    mean += rotate(p.turn[k], {0, 0, 1}) / 77;
  }
  CHECK(norm(mean) < 0.35);  // 77 random directions: 0.11 expected
}

TEST_CASE("a count of drawn sizes has asked for what it delivered once it is exhausted") {
  Simulation sim(with_source(R"({"name": "a", "shape": "ball", "material": "sand", "count": 50,
    "size": {"distribution": "uniform", "lowest": 0.5, "highest": 1.5},
    "region": {"box": {"min": [0, 0, 0], "max": [0.03, 0.03, 0.03]}}})")
                     .file(),
                 test_options());
  sim.step();
  CHECK(sim.world().particles().count() == 50);
  CHECK(sim.world().mass().requested == sim.world().mass().delivered);
  // Drawn sizes are not the mean size 50 times.
  CHECK(std::fabs(sim.world().mass().delivered / (50 * 2000 * sim.world().particles().shapes[0].volume) - 1) > 0.01);
}

TEST_CASE("a rate source delivers the rate, then stops at the mass asked for") {
  // 0.2 kg/s for 0.05 s of a thinning rain that falls out of its region.
  CaseText c = with_source(
      R"({"name": "rain", "shape": "grain", "material": "sand", "mass": 0.01, "rate": 0.2, "velocity": [0, 0, -3],
    "region": {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 0.02], "radius": 0.03}}})");
  c.time = R"({"step": 2e-5, "end": 1})";
  Simulation sim(c.file(), test_options());
  const double grain = 2000 * sim.world().particles().shapes[1].volume;
  for (int k = 1; k <= 10; ++k) {
    while (sim.time() < 0.004 * k - 1e-9) sim.step();
    // One delivery of 2 ms ahead at most.
    const double delivered = sim.world().mass().delivered, owed = 0.2 * sim.time();
    CHECK(delivered >= owed - grain - 1e-12);
    CHECK(delivered <= owed + 0.2 * 0.002 + grain);
  }
  while (sim.time() < 0.07) sim.step();
  CHECK(std::fabs(sim.world().mass().delivered - 0.01) <= grain);
  CHECK(sim.world().mass().inside == near(sim.world().mass().delivered, 1e-12));
  CHECK(worst_overlap(sim) < 0.1);
}

TEST_CASE("a list of sizes shares by mass") {
  Simulation sim(with_source(R"({"name": "a", "shape": "ball", "material": "sand", "mass": 0.05,
    "size": {"distribution": "list", "scales": [0.5, 0.8, 1.2], "shares": [0.2, 0.5, 0.3]},
    "region": {"box": {"min": [0, 0, 0], "max": [0.12, 0.12, 0.12]}}})")
                     .file(),
                 test_options());
  sim.step();
  std::map<double, double> mass;
  const Particles& p = sim.world().particles();
  double total = 0;
  for (std::size_t k = 0; k < p.count(); ++k) {
    mass[p.scale[k]] += p.mass(k);
    total += p.mass(k);
  }
  REQUIRE(mass.size() == 3);
  CHECK(p.count() > 8000);
  // Scatter of the largest of about 1000 draws: 3 %.
  CHECK(mass[0.5] / total == doctest::Approx(0.2).scale(0).epsilon(0.08));
  CHECK(mass[0.8] / total == doctest::Approx(0.5).scale(0).epsilon(0.05));
  CHECK(mass[1.2] / total == doctest::Approx(0.3).scale(0).epsilon(0.08));
}

TEST_CASE("normal sizes have the mean, the deviation and the cut-offs asked for") {
  Simulation sim(with_source(R"({"name": "a", "shape": "ball", "material": "sand", "count": 4000,
    "size": {"distribution": "normal", "mean": 0.8, "deviation": 0.1, "lowest": 0.6, "highest": 1.0},
    "region": {"box": {"min": [0, 0, 0], "max": [0.12, 0.12, 0.12]}}})")
                     .file(),
                 test_options());
  sim.step();
  const Particles& p = sim.world().particles();
  double sum = 0, square = 0;
  for (std::size_t k = 0; k < p.count(); ++k) {
    CHECK(p.scale[k] >= 0.6);
    CHECK(p.scale[k] <= 1.0);
    sum += p.scale[k];
    square += p.scale[k] * p.scale[k];
  }
  const double mean = sum / 4000, deviation = std::sqrt(square / 4000 - mean * mean);
  CHECK(mean == near(0.8, 0.01));
  // Normal cut at two deviations: 0.880 of the deviation.
  CHECK(deviation == near(0.088, 0.05));
}

TEST_CASE("a region too small for what is asked is refused, with what would fit") {
  const CaseText c = with_source(R"({"name": "fill", "shape": "ball", "material": "sand", "count": 5000,
    "region": {"box": {"min": [0, 0, 0], "max": [0.02, 0.02, 0.02]}}})");
  Simulation sim(c.file(), test_options());
  CHECK_THROWS_WITH_AS(sim.step(), doctest::Contains("test.json /sources/0: the region cannot hold"), Error);
  Simulation again(c.file(), test_options());
  CHECK_THROWS_WITH_AS(again.step(), doctest::Contains("particles) fit"), Error);
}

TEST_CASE("given particles that overlap are refused by their numbers; a settled bed may overlap a little") {
  Simulation deep(
      with_given({}, "ball", {{{0, 0, 0}, {}, {}, {}}, {{0.01, 0, 0}, {}, {}, {}}, {{0.0018, 0, 0}, {}, {}, {}}}),
      test_options());
  CHECK_THROWS_WITH_AS(
      deep.step(), doctest::Contains("particles number 0 and 2 overlap by 0.0002 m at the start, 20 % of the radius"),
      Error);
  Simulation slight(with_given({}, "ball", {{{0, 0, 0}, {}, {}, {}}, {{0.00197, 0, 0}, {}, {}, {}}}), test_options());
  slight.step();
  CHECK(slight.counters().touching == 1);
}

TEST_CASE("given particles that overlap across a periodic face are refused too") {
  CaseText c;
  c.domain = R"({"min": [0, 0, 0], "max": [0.02, 0.02, 0.02], "periodic": [true, false, false]})";
  Simulation sim(with_given(c, "ball", {{{0.0002, 0.01, 0.01}, {}, {}, {}}, {{0.0195, 0.01, 0.01}, {}, {}, {}}}),
                 test_options());
  CHECK_THROWS_WITH_AS(sim.step(), doctest::Contains("particles number 0 and 1 overlap"), Error);
}

TEST_CASE("given particles of two sources must not stand in each other") {
  CaseFile file = with_given({}, "ball", {{{0, 0, 0}, {}, {}, {}}});
  file.settings.sources.push_back(given_source("ball", {{{0.0012, 0, 0}, {}, {}, {}}}));
  Simulation sim(file, test_options());
  CHECK_THROWS_WITH_AS(
      sim.step(),
      doctest::Contains("particle number 0 at (0.0012, 0, 0) m overlaps a particle of another source or a part"),
      Error);
}

TEST_CASE("given particles must not stand in a part") {
  CaseText c;
  c.parts = R"([{"name": "floor", "geometry": "calx.plane", "material": "sand"}])";
  Simulation sim(with_given(c, "grain", {{{0, 0, 0.0012}, {}, {}, {}}}), test_options());
  CHECK_THROWS_WITH_AS(sim.step(), doctest::Contains("or a part by more than 5 % of its radius"), Error);
  Simulation slight(with_given(c, "grain", {{{0, 0, 0.00128}, {}, {}, {}}}), test_options());
  slight.step();
  CHECK(slight.counters().touching == 1);
}

TEST_CASE("a later fill keeps clear of particles and parts already there") {
  for (const bool periodic : {false, true}) {
    CaseText c;
    c.domain = std::string(R"({"min": [0, 0, 0], "max": [0.02, 0.02, 0.02], "periodic": [)") +
               (periodic ? "true, true, true]}" : "false, false, false]}");
    c.sources =
        R"([{"name": "a", "shape": "ball", "material": "sand", "count": 60, "region": {"box": {"min": [0, 0, 0], "max": [0.02, 0.02, 0.02]}}},
      {"name": "b", "shape": "ball", "material": "sand", "count": 12, "when": {"time": 0.0001}, "region": {"box": {"min": [0, 0, 0], "max": [0.02, 0.02, 0.02]}}},
      {"name": "c", "shape": "ball", "material": "sand", "mass": 0.0004, "rate": 1, "when": {"time": 0.0002}, "region": {"box": {"min": [0, 0, 0], "max": [0.02, 0.02, 0.02]}}}])";
    c.parts =
        R"([{"name": "shelf", "geometry": "calx.plane", "material": "sand", "parameters": {"point": [0.01, 0.01, 0.0101], "half_u": 0.02, "half_v": 0.02}}])";
    const Wrap wrap{{0, 0, 0}, {0.02, 0.02, 0.02}, {periodic, periodic, periodic}};
    for (int seed = 1; seed <= 12; ++seed) {
      c.more = "\"seed\": " + std::to_string(seed);
      Simulation sim(c.file(), test_options());
      advance(sim, 40);
      CAPTURE(periodic);
      CAPTURE(seed);
      CHECK(sim.world().particles().count() > 72);
      CHECK(worst_overlap(sim, wrap) <= 0);
      for (const auto& contact : sim.world().contacts()) CHECK(contact.part < 0);
    }
  }
}

TEST_CASE("an event starts a source") {
  CaseText c = with_source(R"({"name": "late", "shape": "ball", "material": "sand", "count": 3, "when": {"time": 0.001},
    "region": {"box": {"min": [0, 0, 0], "max": [0.03, 0.03, 0.03]}}})");
  Simulation sim(c.file(), test_options());
  advance(sim, 99);
  CHECK(sim.world().particles().count() == 0);
  advance(sim, 3);
  CHECK(sim.world().particles().count() == 3);
  CHECK(sim.world().mass().inserted_count == 3);
}

TEST_CASE("particles come from a file, with velocities, spins and scales") {
  const TemporaryFile csv("# bed\nx_m,y_m,z_m,vx_m_s,wz_rad_s,scale\n0,0,0,1,5,1\r\n0.01,0.002,-0.003,-1,0,0.5\n");
  Simulation sim(with_balls_of(csv.path).file(), test_options());
  CHECK(sim.step_limits().size() > 0);
  sim.step();
  const Particles& p = sim.world().particles();
  REQUIRE(p.count() == 2);
  CHECK(body_of(sim, 0).vx == 1);
  CHECK(body_of(sim, 0).wz == near(5, 1e-15));
  CHECK(body_of(sim, 1).r == 0.5e-3);
  CHECK(body_of(sim, 1).z == -0.003);
}

TEST_CASE("a file of particles with a fault is refused with its line") {
  for (const auto& row :
       std::map<std::string, std::string>{{"x_m,y_m\n0,0\n", ":1: the header lacks the column z_m"},
                                          {"x_m,y_m,z_m\n0,0,zero\n", ":2: \"zero\" is not a finite number"},
                                          {"x_m,y_m,z_m\n0,0,0\n1,2\n", ":3: 2 values under 3 columns"},
                                          {"x_m,y_m,z_m,colour\n0,0,0,1\n", "column \"colour\" is not known"},
                                          {"x_m,y_m,z_m\n0,0,0x\n", ":2: \"0x\" is not a finite number"},
                                          {"x_m,y_m,z_m,scale\n0,0,0,-1\n", ":2: a scale of -1"}}) {
    const TemporaryFile csv(row.first);
    const CaseText c = with_balls_of(csv.path);
    CAPTURE(row.first);
    CHECK_THROWS_WITH_AS(Simulation(c.file(), test_options()), doctest::Contains(row.second.c_str()), Error);
  }
}

TEST_CASE("large particles of a file are seen to overlap") {
  const TemporaryFile csv("x_m,y_m,z_m,scale\n0,0,0,4\n0.0065,0,0,4\n");
  Simulation sim(with_balls_of(csv.path).file(), test_options());
  CHECK_THROWS_WITH_AS(sim.step(), doctest::Contains("particles number 0 and 1 overlap"), Error);
}

TEST_CASE("the smallest particle of a file limits the time step") {
  const TemporaryFile csv("x_m,y_m,z_m,scale\n0,0,0,1\n0.01,0,0,0.1\n");
  CaseText c = with_balls_of(csv.path);
  c.time = R"({"end": 1})";
  Simulation sim(c.file(), test_options());
  CHECK(sim.step_limits().at(0).where.find("0.0001 m") != std::string::npos);
}
