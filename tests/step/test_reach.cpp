// Laws that act between surfaces that do not touch, through the engine: calx.liquid-bridge beside calx.linear between
// spheres, with walls and facets, in both precisions and every instruction set; devices, threads, restart, rest.
#include <doctest/doctest.h>

#include <cmath>

#include "scenes/device_kinds.hpp"
#include "support/case.hpp"
#include "support/memory_state.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

constexpr double kPi = 3.14159265358979323846, kR = 1e-3, kTension = 0.0728, kVolume = 1e-12;
constexpr double kMass = 2000 * 4.0 / 3 * kPi * kR * kR * kR;
const double kRupture = std::cbrt(kVolume);

const char* const kBridge = R"({"law": "calx.liquid-bridge", "parameters": {"volume": 1e-12}})";

std::string linear(const std::string& more = "\"restitution\": 1, \"friction\": 0") {
  return "{\"law\": \"calx.linear\", \"parameters\": {\"kn\": 4000, " + more + "}}";
}
CaseText wet(const std::string& laws = linear() + ", " + kBridge) {
  CaseText c;
  c.contacts = R"([{"between": ["sand", "sand"], "laws": [)" + laws + "]}]";
  c.time = R"({"step": 1e-6, "end": 10})";
  return c;
}
/// Work of the capillary pull of a radius R (2 r_eff) from one gap to another, J.
double work(double r, double from, double to) {
  const double a = 2 * kVolume / (kPi * r);
  const auto at = [&](double s) { return std::sqrt(s * s + a) - s; };
  return 2 * kPi * kTension * r * (at(from) - at(to));
}
std::unique_ptr<Simulation> after(const CaseFile& file, int steps, SimulationOptions o = test_options()) {
  auto sim = std::make_unique<Simulation>(file, o);
  advance(*sim, steps);
  return sim;
}
double parting(const Simulation& sim) { return body_of(sim, 1).vx - body_of(sim, 0).vx; }

/// Two balls that meet head-on at a relative speed v, in slots of the x axis.
CaseFile impact(double v, const CaseText& c = wet()) {
  return with_given(c, "ball",
                    {{{-kR - 1e-6, 0, 0}, {0.5 * v, 0, 0}, {}, {}}, {{kR + 1e-6, 0, 0}, {-0.5 * v, 0, 0}, {}, {}}});
}

/// Clumps and balls of two materials in a box of facets, one pair of materials dry; everything moves and touches.
CaseFile bed(const std::string& integrator, bool periodic = false, const std::string& more = "") {
  CaseText c;
  c.gravity = "[0, 0, -9.81]";
  c.time = R"({"integrator": ")" + integrator + R"(", "step": 5e-6, "end": 10})";
  c.materials = R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25},
                    "iron": {"density": 7000, "young": 2e7, "poisson": 0.3}})";
  if (periodic) c.domain = R"({"min": [0, 0, -0.02], "max": [0.024, 0.024, 0.2], "periodic": [true, true, false]})";
  const std::string dry = linear(R"("restitution": 0.5, "friction": 0.4, "rolling": "epsd2", "rolling_friction": 0.1)");
  const std::string drops = R"({"law": "calx.liquid-bridge", "parameters": {"relative_volume": 0.002,
    "viscosity": 0.01, "least_gap": 1e-5, "formation_distance": 2e-5}})";
  // History that lasts as long as the contact: the largest force so far.
  const std::string load = R"({"law": "calx.load-cohesion", "parameters": {"ratio": 0.1}})";
  c.contacts = R"([{"between": ["sand", "sand"], "laws": [)" + dry + ", " + load + ", " + drops +
               R"(]}, {"between": ["sand", "iron"], "laws": [)" + kBridge + ", " + dry + ", " + load +
               R"(]}, {"between": ["iron", "iron"], "laws": [)" + dry + "]}]";
  c.parts = R"([{"name": "box", "geometry": "calx.box", "material": "iron",
                 "parameters": {"min": [-0.001, -0.001, 0], "max": [0.025, 0.025, 0.1]}}])";
  c.more = more;
  const auto particles = lattice(256, 8, 8, 2.9e-3, {2e-4, 2e-4, 2e-4}, 5e-5, 1.0);
  CaseFile file = with_given(c, "grain", {particles.begin(), particles.begin() + 192});
  file.settings.sources.push_back(given_source("ball", {particles.begin() + 192, particles.end()}, "iron"));
  file.settings.sources.push_back(given_source("odd", lattice(72, 6, 6, 3.6e-3, {1e-3, 1e-3, 1.25e-2}, 5e-5, 1.0, 2)));
  return file;
}

}  // namespace

TEST_CASE("after an impact a bridge takes its work of separation, then breaks and acts no more") {
  const double v = 0.1, lost = work(kR, 0, kRupture);
  const double expected = std::sqrt(v * v - 2 * lost / (0.5 * kMass));
  for (const bool mixed : {false, true}) {
    SimulationOptions o = test_options();
    o.mixed = mixed;
    Simulation sim(impact(v), o);
    advance(sim, 1);
    while (parting(sim) < 0) advance(sim, 1);
    // Within reach it goes on pulling; it has gone when the spheres are apart by more.
    std::uint64_t apart = 0;
    while (body_of(sim, 1).x - body_of(sim, 0).x < 2 * kR + kRupture) {
      advance(sim, 1);
      apart += sim.counters().touching == 0;
    }
    // 1e-4 m at about 0.09 m/s, 1e-6 s a step.
    CHECK(apart > 1000);
    // One step of the pull at contact, 2 pi gamma R dt / m* = 1.1e-4 m/s, is the most that Euler's step can misplace.
    CHECK(std::fabs(parting(sim) - expected) < 1.1e-4);
    const double now = parting(sim);
    advance(sim, 500);
    CHECK(parting(sim) == now);
  }
}

TEST_CASE("grains too slow for the bridge are caught and stay within its reach") {
  const double v = 0.8 * std::sqrt(2 * work(kR, 0, kRupture) / (0.5 * kMass));
  // With a damped spring the two come to rest where the spring bears the pull.
  const auto sim = after(impact(v, wet(linear(R"("restitution": 0.5, "friction": 0)") + ", " + kBridge)), 60000);
  const double overlap = 2 * kR - (body_of(*sim, 1).x - body_of(*sim, 0).x);
  CHECK(overlap == near(2 * kPi * kTension * kR / 4000, 1e-6));
  CHECK(sim->counters().touching == 1);
}

TEST_CASE("the energy ledger closes through forming, pulling and breaking") {
  for (const char* integrator : {"euler", "verlet"}) {
    CaseText c = wet();
    c.time = std::string(R"({"integrator": ")") + integrator + R"(", "step": 2e-7, "end": 10})";
    c.more = "\"energy\": true";
    Simulation sim(impact(0.1, c), test_options());
    const double start = 0.25 * kMass * 0.1 * 0.1;
    double worst = 0;
    for (int k = 0; k < 120; ++k) {
      advance(sim, 100);
      const auto e = sim.world().energy();
      worst = std::max(worst, std::fabs(e.kinetic_translation + e.elastic + e.plastic - start));
    }
    CHECK(body_of(sim, 1).x - body_of(sim, 0).x > 2 * kR + kRupture);
    const auto e = sim.world().energy();
    CHECK(e.elastic == 0);
    // It forms a step after the spheres touch, at an overlap of up to v dt = 2e-8 m, which adds 2e-4 of its depth.
    CHECK(e.plastic == near(work(kR, 0, kRupture), 1e-3));
    CHECK(worst < 2e-3 * work(kR, 0, kRupture));
  }
}

TEST_CASE("a sphere hangs from facets and in a corner by its bridges, and falls where it is too heavy") {
  // A bridge holds what weighs less than 4 pi gamma R = 0.91 mN, 11 times the weight of this sphere.
  CaseText c = wet(linear(R"("restitution": 0.2, "friction": 0.3)") + ", " + kBridge);
  c.time = R"({"step": 2e-6, "end": 10})";
  c.gravity = "[0, 0, -9.81]";
  c.parts = R"([{"name": "lid", "geometry": "calx.box", "material": "sand",
                 "parameters": {"min": [-0.01, -0.01, 0], "max": [0.01, 0.01, 0.01]}}])";
  const double wall_pull = 4 * kPi * kTension * kR, weight = 9.81 * kMass;
  Simulation held(with_given(c, "ball", {{{0.002, 0.001, -kR + 1e-7}, {}, {}, {}}}), test_options());
  advance(held, 40000);
  // Near contact the pull hardly falls with the gap; the spring bears the difference.
  CHECK(4000 * (body_of(held, 0).z + kR) == near(wall_pull - weight, 1e-5));
  CHECK(held.world().part_load(0).force.z == near(-weight, 1e-5));

  // In a corner it has two bridges, the one at the side drawing it in. Without friction they do not know of each other.
  CaseText corner = wet(linear(R"("restitution": 0.2, "friction": 0)") + ", " + kBridge);
  corner.time = c.time;
  corner.gravity = c.gravity;
  corner.parts = R"([{"name": "box", "geometry": "calx.box", "material": "sand",
                      "parameters": {"min": [0, -0.01, -0.02], "max": [0.02, 0.01, 0]}}])";
  Simulation cornered(with_given(corner, "ball", {{{kR - 1e-7, 0.001, -kR + 1e-7}, {}, {}, {}}}), test_options());
  advance(cornered, 40000);
  CHECK(4000 * (body_of(cornered, 0).z + kR) == near(wall_pull - weight, 1e-5));
  CHECK(4000 * (kR - body_of(cornered, 0).x) == near(wall_pull, 1e-5));
  CHECK(cornered.counters().touching == 2);

  // A particle thirty times as dense is too heavy: it falls, and passes the end of the bridge having lost its work.
  c.materials = R"({"sand": {"density": 60000, "young": 1e7, "poisson": 0.25}})";
  Simulation fell(with_given(c, "ball", {{{0.002, 0.001, -kR + 1e-9}, {}, {}, {}}}), test_options());
  double gap = 0;
  while (gap < kRupture) {
    advance(fell, 1);
    gap = -body_of(fell, 0).z - kR;
    REQUIRE(fell.time() < 0.1);
  }
  const double m = 30 * kMass, v2 = 2 * (9.81 * gap - work(2 * kR, 0, kRupture) / m);
  CHECK(-body_of(fell, 0).vz == near(std::sqrt(v2), 5e-3));  // a step of 2e-6 s in 5 ms, and the overlap it starts from
}

TEST_CASE("laws without reach beside one with reach act as without it while bridges have no liquid") {
  // The same bed with bridges of no volume: rows, blocks and lists are as ever, to the bit.
  const auto with = [](const std::string& volume) {
    CaseFile file = bed("euler");
    CaseText c;
    c.materials = R"({"sand": {"density": 2000, "young": 1e7, "poisson": 0.25},
                      "iron": {"density": 7000, "young": 2e7, "poisson": 0.3}})";
    const std::string dry =
        linear(R"("restitution": 0.5, "friction": 0.4, "rolling": "epsd2", "rolling_friction": 0.1)");
    const std::string drop =
        volume.empty() ? "" : R"(, {"law": "calx.liquid-bridge", "parameters": {"volume": )" + volume + "}}";
    c.contacts = "[";
    for (const char* pair : {R"(["sand", "sand"])", R"(["sand", "iron"])", R"(["iron", "iron"])"})
      c.contacts +=
          std::string(c.contacts.size() > 1 ? "," : "") + "{\"between\": " + pair + ", \"laws\": [" + dry + drop + "]}";
    c.contacts += "]";
    file.settings.contacts = c.file().settings.contacts;
    return file;
  };
  const auto positions = [](const Simulation& sim) {
    std::vector<double> out;
    for (std::uint32_t id = 0; id < 328; ++id)
      for (const double x : {body_of(sim, id).x, body_of(sim, id).vy, body_of(sim, id).wz}) out.push_back(x);
    return out;
  };
  const auto dry = after(with(""), 200), no_liquid = after(with("0"), 200);
  CHECK(dry->counters().touching > 20);
  CHECK(positions(*dry) == positions(*no_liquid));
  // A bridge of next to nothing has reach, so that rows apart are gone through; its pull, 5e-4 N for 1e-6 m, does act.
  const auto little = after(with("1e-30"), 200);
  CHECK(dry->counters().touching == little->counters().touching);
  CHECK(positions(*dry) != positions(*little));
}

TEST_CASE("a wide bridge holds over rebuilds of the lists and over a restart") {
  // It reaches 4.6e-4 m, more than twice the margin of 1e-4 m that a slow particle has.
  const double volume = 1e-10, reach = std::cbrt(volume), v = 0.3, a = 2 * volume / (kPi * kR);
  const CaseFile file =
      impact(v, wet(linear() + R"(, {"law": "calx.liquid-bridge", "parameters": {"volume": 1e-10}})"));
  const double lost = 2 * kPi * kTension * kR * (std::sqrt(a) - std::sqrt(reach * reach + a) + reach);
  auto sim = std::make_unique<Simulation>(file, test_options());
  const auto gap = [&] { return body_of(*sim, 1).x - body_of(*sim, 0).x - 2 * kR; };
  advance(*sim, 300);
  CHECK(gap() > 0);
  while (gap() < 0.95 * reach) advance(*sim, 1);
  MemoryState state;
  sim->save(state);
  sim = std::make_unique<Simulation>(file, test_options());
  sim->load(state);
  // Laws that reach less far go on from it, too: there the bridge has ended.
  Simulation less(impact(v), test_options());
  less.load(state);
  const double speed = parting(less);
  advance(less, 100);
  CHECK(parting(less) == speed);
  while (gap() < 1.01 * reach) advance(*sim, 1);
  CHECK(sim->counters().rebuilds >= 3);
  CHECK(std::fabs(parting(*sim) - std::sqrt(v * v - 2 * lost / (0.5 * kMass))) < 2e-4);
}

TEST_CASE("a bed with bridges has the same bits for any number of threads") {
  for (const bool mixed : {false, true})
    for (const char* integrator : {"euler", "verlet"}) {
      SimulationOptions o = test_options(1);
      o.mixed = mixed;
      const auto one = after(bed(integrator, true), 300, o);
      CHECK(one->counters().rebuilds > 3);
      o.threads = 3;
      CHECK(after(bed(integrator, true), 300, o)->digest() == one->digest());
    }
}

TEST_CASE("a bed with bridges goes on from a checkpoint to the bit, bridges between grains apart included") {
  for (const char* integrator : {"euler", "verlet"}) {
    const CaseFile file = bed(integrator, true);
    const auto straight = after(file, 400);
    for (const int stop : {1, 137, 250}) {
      auto sim = after(file, stop);
      MemoryState state;
      sim->save(state);
      Simulation resumed(file, test_options(2));
      resumed.load(state);
      advance(resumed, 400 - stop);
      CHECK(resumed.digest() == straight->digest());
    }
  }
}

TEST_CASE("bridges sleep with the grains: contacts are counted as ever, and a pull that ends wakes") {
  // A row of balls hangs from the next by bridges, all at rest; the uppermost is held by a lid that then goes away.
  CaseText c = wet(linear(R"("restitution": 0.2, "friction": 0.3)") + ", " + kBridge);
  c.time = R"({"step": 2e-6, "end": 10})";
  c.gravity = "[0, 0, -9.81]";
  c.parts = R"([{"name": "lid", "geometry": "calx.box", "material": "sand", "motion": "away",
                 "parameters": {"min": [-0.01, -0.01, 0], "max": [0.01, 0.01, 0.01]}}])";
  c.more = R"("motions": {"away": {"plugin": "calx.travel", "start": "go", "parameters": {
      "displacement": [0, 0, 0.01], "speed": 0.5}}},
    "events": {"go": {"when": {"time": 0.1}}},
    "rest": {"after": 0.004, "displacement": 0.01, "force": 0.2})";
  std::vector<Given> row;
  for (int k = 0; k < 3; ++k) row.push_back({{0.002, 0.001, -kR - 2 * kR * k + 1e-7 * (k + 1)}, {}, {}, {}});
  Simulation sim(with_given(c, "ball", row), test_options());
  advance(sim, 45000);
  CHECK(sim.counters().asleep == 3);
  CHECK(sim.counters().touching == 3);
  CHECK(sim.world().contacts().size() == 3);
  CHECK(sim.world().part_load(0).force.z == near(-3 * 9.81 * kMass, 0.2));  // to the tolerance of rest
  advance(sim, 15000);
  CHECK(sim.counters().asleep == 0);
  CHECK(body_of(sim, 2).z < -5 * kR - 1e-3);
}

TEST_CASE("devices have the bits of the processor with bridges between spheres, facets and clumps") {
  for (const bool mixed : {false, true}) {
    SimulationOptions o = test_options();
    o.mixed = mixed;
    const CaseFile file = bed(mixed ? "verlet" : "euler", true, "\"energy\": true");
    const auto reference = after(file, 200, o);
    CHECK(reference->counters().touching > 20);
    for (const std::string& device : test_devices()) {
      CAPTURE(device);
      CAPTURE(mixed);
      o.device = device;
      const auto sim = after(file, 200, o);
      CHECK(sim->device().find(device) == 0);
      CHECK(sim->digest() == reference->digest());
      CHECK(sim->counters().touching == reference->counters().touching);
      CHECK(sim->world().energy().elastic == reference->world().energy().elastic);
      CHECK(sim->world().energy().plastic == reference->world().energy().plastic);
      // From a checkpoint of the processor.
      SimulationOptions on_host = o;
      on_host.device = "cpu";
      MemoryState state;
      after(file, 90, on_host)->save(state);
      Simulation resumed(file, o);
      resumed.load(state);
      advance(resumed, 110);
      CHECK(resumed.digest() == reference->digest());
    }
  }
}
