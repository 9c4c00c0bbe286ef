// The contacts of contact_worlds.hpp have the processor's bits on every device, in both precisions.
#include <doctest/doctest.h>

#include "scenes/device_kinds.hpp"
#include "step/contact_worlds.hpp"

using namespace calx;
using namespace calx::contact_worlds;

namespace {

void check_world(const CaseFile& file, int steps) {
  for (const bool mixed : {false, true}) {
    SimulationOptions o = test_options();
    o.mixed = mixed;
    Simulation reference(file, o);
    const std::string before = reference.digest();
    advance(reference, steps);
    CHECK(reference.digest() != before);
    for (const std::string& device : test_devices()) {
      CAPTURE(device);
      CAPTURE(mixed);
      o.device = device;
      Simulation sim(file, o);
      advance(sim, steps);
      CHECK(sim.device().find(device) == 0);
      CHECK(sim.digest() == reference.digest());
    }
  }
}

}  // namespace

TEST_CASE("pairs of spheres: the bits of the processor on every device") { check_world(pairs(), kPairSteps); }
TEST_CASE("spheres on a floor: the bits of the processor on every device") { check_world(on_floor(), kFloorSteps); }
TEST_CASE("clumps: the bits of the processor on every device") { check_world(clumps(), kClumpSteps); }
