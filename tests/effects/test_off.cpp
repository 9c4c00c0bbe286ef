// Every effect of the tree: at its off value a case gives the bits it gives without, at its typical strength others.
#include <doctest/doctest.h>

#include <cstring>
#include <set>

#include "effects/machine.hpp"

using namespace calx;

namespace {

const int steps = 2500;  // 0.05 s: grains have fallen on the turning rotor and into the canister

std::vector<double> machine_history(const std::string& effects) {
  Simulation sim = machine(effects);
  return history(sim, steps, 100);
}

/// Bits, but for the sign of zero.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = a[k] + 0.0, y = b[k] + 0.0;
    if (std::memcmp(&x, &y, sizeof x) != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("every effect off gives the bits of the case without it, and on gives others") {
  const std::vector<double> without = machine_history("");
  CHECK(without.size() > 800);
  // What a nozzle's ring or the age of a slow opening does is not seen by 80 grains in 0.05 s.
  const std::set<std::string> unseen = {"calx.nozzle-lip"};
  const auto effects = list_effects({CALX_PLUGIN_DIR});
  CHECK(effects.size() >= 24);
  for (const EffectInfo& effect : effects) {
    CAPTURE(effect.id);
    CHECK(same_bits(machine_history(use_of(effect)), without));
    if (unseen.count(effect.id) == 0) CHECK(!same_bits(machine_history(use_of(effect, 1)), without));
  }
}

TEST_CASE("effects that are off do not disturb each other, in any order") {
  const auto effects = list_effects({CALX_PLUGIN_DIR});
  std::string forward, backward;
  for (const EffectInfo& effect : effects) {
    const std::string use = use_of(effect), one = use.substr(1, use.size() - 2);
    forward += (forward.empty() ? "" : ", ") + one;
    backward = one + (backward.empty() ? "" : ", ") + backward;
  }
  const std::vector<double> without = machine_history("");
  CHECK(same_bits(machine_history("[" + forward + "]"), without));
  CHECK(same_bits(machine_history("[" + backward + "]"), without));
}
