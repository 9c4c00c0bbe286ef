// law_setups.hpp: every contact law with its rolling models and options, for tests of what all laws keep.
#pragma once
#include "support/law_bench.hpp"

namespace bench {

struct Setup {
  const char* library;
  Choices choices;
  Values values;
};
inline std::vector<Setup> all_setups() {
  const Values hm = {{"restitution", 0.4}, {"friction", 0.5}};
  Values hm_roll = hm;
  hm_roll.insert({{"rolling_friction", 0.1}, {"rolling_stiffness", 500}, {"rolling_viscosity", 0.01}});
  std::vector<Setup> all;
  for (const char* rolling : {"none", "a", "epsd", "epsd2", "sds", "cdt"}) {
    all.push_back({"calx-hertz-mindlin", {{"rolling", rolling}}, hm_roll});
    Values linear = hm_roll;
    linear["kn"] = 1e3;
    all.push_back({"calx-linear", {{"rolling", rolling}}, linear});
  }
  all.push_back({"calx-hertz-mindlin", {{"tension", "clipped"}, {"tangential", "rescaled"}}, hm});
  for (const char* exponent : {"1", "1.5"})
    for (const char* rolling : {"none", "epsd"}) {
      Values v = hm_roll;
      v.insert({{"plasticity", 0.5}, {"surface_energy", 1}, {"pull_off", 1e-5}});
      all.push_back({"calx-epam", {{"exponent", exponent}, {"rolling", rolling}}, v});
      all.push_back({"calx-epam",
                     {{"exponent", exponent},
                      {"rolling", rolling},
                      {"adhesion_exponent", "4.5"},
                      {"adhesion_cap", "literal"},
                      {"dashpot", "always"}},
                     v});
    }
  return all;
}

}  // namespace bench
