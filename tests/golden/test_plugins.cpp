// Plugins built for other releases of the boundary run here and do what they did: the golden binary of ABI 1.0, and one
// as a later minor release might have it.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.hpp"
#include "scenes/device_kinds.hpp"
#include "support/case.hpp"
#include "support/near.hpp"

using namespace calx;

namespace {

constexpr double kR = 1e-3, kMass = 2000 * 4.0 / 3 * 3.14159265358979323846 * kR * kR * kR;
constexpr double kSpring = 1000, kPull = 2e-4, kLength = 5e-5, kSpeed = 0.1;

SimulationOptions golden_options() {
  SimulationOptions o = test_options();
  o.plugin_path = {CALX_GOLDEN_DIR};
  return o;
}

/// Two balls that meet head-on, each at half of the relative speed.
CaseFile impact(const std::string& parameters) {
  CaseText c;
  c.time = R"({"step": 1e-6, "end": 10})";
  c.contacts = R"([{"between": ["sand", "sand"], "law": "test.golden-law", "parameters": )" + parameters + "}]";
  return with_given(
      c, "ball",
      {{{-kR - 1e-7, 0, 0}, {0.5 * kSpeed, 0, 0}, {}, {}}, {{kR + 1e-7, 0, 0}, {-0.5 * kSpeed, 0, 0}, {}, {}}});
}
double gap(const Simulation& sim) { return body_of(sim, 1).x - body_of(sim, 0).x - 2 * kR; }
double parting(const Simulation& sim) { return body_of(sim, 1).vx - body_of(sim, 0).vx; }

std::string refusal(const std::string& force) {
  CaseText c;
  c.more = R"("forces": [{"plugin": ")" + force + "\"}]";
  c.contacts = "[]";
  try {
    Simulation sim(with_given(c, "ball", {{}}), golden_options());
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the golden binary of ABI 1.0 meets its closed form on the processor and on every device") {
#if !defined(__x86_64__)
  MESSAGE("skipped: the golden binary is one of x86-64");
  return;
#endif
  // Two strings of kPull take 2 kPull kLength of the energy of the parting spheres.
  const double m = 0.5 * kMass;
  const double expected = std::sqrt(kSpeed * kSpeed - 2 * 2 * kPull * kLength / m);
  const CaseFile file = impact(R"({"strings": 2, "spring": 1000, "pull": 2e-4, "length": 5e-5})");
  Simulation sim(file, golden_options());
  int steps = 1;
  advance(sim, 1);
  while (parting(sim) < 0) advance(sim, 1), ++steps;
  // m d'' = -k d + F turns at tan(omega t) = -v k / (F omega); they meet after 2e-6 s. To two steps.
  const double omega = std::sqrt(kSpring / m);
  const double turn = (0.5 * 3.14159265 + std::atan(2 * kPull * omega / (kSpeed * kSpring))) / omega;
  CHECK(std::fabs(steps * 1e-6 - 2e-6 - turn) <= 2e-6);
  while (gap(sim) < 1.01 * kLength) advance(sim, 1), ++steps;
  // One step of the pull, 1e-4 m/s, is what Euler's step may misplace at either end.
  CHECK(std::fabs(parting(sim) - expected) < 2e-4);
  CHECK(std::fabs(kSpeed - expected) > 4e-3);
  const double after = parting(sim);
  advance(sim, 200);
  CHECK(parting(sim) == after);
  const std::string digest = sim.digest();
  // Its text of 1.0, compiled anew by devices, has the bits of its native code.
  for (const std::string& device : test_devices()) {
    CAPTURE(device);
    SimulationOptions o = golden_options();
    o.device = device;
    Simulation other(file, o);
    advance(other, steps + 200);
    CHECK(other.digest() == digest);
  }
  // And its native code in single precision runs, too.
  SimulationOptions o = golden_options();
  o.mixed = true;
  Simulation mixed(file, o);
  advance(mixed, steps + 200);
  CHECK(parting(mixed) == near(after, 1e-5));
}

TEST_CASE("a plugin of a later minor release runs, its larger structs and unknown ids notwithstanding") {
  CaseText c;
  c.time = R"({"step": 5e-6, "end": 10})";
  c.contacts = "[]";
  c.more = R"("forces": [{"plugin": "test.newer-minor", "parameters": {"acceleration": 3}}])";
  Simulation sim(with_given(c, "ball", {{}}), golden_options());
  advance(sim, 20000);
  CHECK(body_of(sim, 0).vx == near(3 * 0.1, 1e-12));
  // Semi-implicit Euler: a t (t + dt) / 2.
  CHECK(body_of(sim, 0).x == near(0.5 * 3 * 0.1 * (0.1 + 5e-6), 1e-12));
}

TEST_CASE("a plugin of a later release that cannot do without what this host lacks is refused with its name") {
  const std::string text = refusal("test.newer-needs");
  CHECK(text.find("test.newer-needs needs the host extension calx.host.weather/1, which this host lacks") !=
        std::string::npos);
}
