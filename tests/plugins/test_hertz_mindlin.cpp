// test_hertz_mindlin.cpp: calx.hertz-mindlin against closed forms, digitised benchmarks and stored answers.
#include <doctest/doctest.h>

#include "support/law_bench.hpp"

using namespace bench;

namespace {
const char* kLib = "calx-hertz-mindlin";

}  // namespace

TEST_CASE("Tsuji dashpot returns the restitution asked for when tension is allowed") {
  for (const double e : {0.1, 0.3, 0.5, 0.9, 1.0}) {
    const Law law(kLib, {}, {{"restitution", e}, {"friction", 0}});
    const Body s = sphere(1.25e-3, 2100, {}, {});
    Record r;
    const double out = restitution(law, s, wall(), 0.5, 1e-7, 1, &r);
    CHECK(out == doctest::Approx(e).epsilon(1e-3));
    const double before = 0.5 * s.m * 0.25, lost = before * (1 - e * e);
    CHECK(std::fabs(r.damping - lost) < 2e-3 * before);
    CHECK(r.friction == doctest::Approx(0));
  }
}

TEST_CASE("clipping the tensile part raises restitution 0.3 to 0.397") {
  const Law law(kLib, {{"tension", "clipped"}}, {{"restitution", 0.3}, {"friction", 0}});
  CHECK(restitution(law, sphere(1.25e-3, 2100, {}, {}), wall(), 0.5, 1e-7, 1) == doctest::Approx(0.397).epsilon(2e-3));
}
