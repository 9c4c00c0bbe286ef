// The nearest known name of a misspelt one.
#include <doctest/doctest.h>

#include "base/nearest.hpp"

using namespace calx;

TEST_CASE("slips of the finger find the key that was meant") {
  const std::vector<std::string> keys = {"density", "young", "poisson", "frames_every", "end"};
  CHECK(nearest_name("yuong", keys) == "young");
  CHECK(nearest_name("Density", keys) == "density");
  CHECK(nearest_name("desnity", keys) == "density");
  CHECK(nearest_name("frames", keys) == "frames_every");
  CHECK(nearest_name("ned", keys) == "end");
}

TEST_CASE("a name that resembles nothing gets no guess") {
  CHECK(nearest_name("viscosity", {"density", "young"}) == "");
  CHECK(nearest_name("k", {"m", "n"}) == "");
  CHECK(nearest_name("x", {}) == "");
}

TEST_CASE("of two equally near names the first is offered") { CHECK(nearest_name("k3", {"k1", "k2"}) == "k1"); }

TEST_CASE("the hint lists what is known when nothing is near") {
  CHECK(did_you_mean("yuong", {"density", "young"}) == "did you mean \"young\"?");
  CHECK(did_you_mean("viscosity", {"density", "young"}) == "known are \"density\", \"young\"");
  CHECK(did_you_mean("viscosity", {"young"}) == "known is \"young\"");
  CHECK(did_you_mean("viscosity", {}) == "none is defined");
}
