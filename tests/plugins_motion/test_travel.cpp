// calx.travel: canister lowering and slide gates.
#include "motion_checks.hpp"

using namespace calx_test;

namespace {
const char library[] = "calx_travel", id[] = "calx.travel";
}

TEST_CASE("velocity is the derivative of the pose for every profile and ending") {
  for (const double profile : {0.0, 1.0, 2.0})
    for (const double then : {0.0, 1.0}) {
      const LoadedMotion m(library, id,
                           {{"profile", profile},
                            {"then", then},
                            {"hold", 0.125 * then},
                            {"duration", 0.75},
                            {"displacement_x", 0.3},
                            {"displacement_y", -0.1},
                            {"displacement_z", 0.7}});
      check_motion(m, {0.75, 0.875, 1.625}, 1.7);
    }
}

TEST_CASE("a canister is lowered by 60 mm at 30 mm/s in 2 s") {
  const LoadedMotion m(library, id, {{"displacement_z", -0.06}, {"speed", 0.03}});
  CHECK(m.duration() == doctest::Approx(2));
  CHECK(m.raw(1).displacement[2] == doctest::Approx(-0.03));
  CHECK(m.raw(1).velocity[2] == doctest::Approx(-0.03));
  CHECK(m.raw(3).displacement[2] == -0.06);
  CHECK(m.raw(1).quaternion[0] == 1);
  CHECK(m.top_speed(1) == doctest::Approx(0.03));
}

TEST_CASE("speed is the largest speed, so smooth profiles take longer") {
  const LoadedMotion trapezoid(library, id, {{"displacement_z", -0.06}, {"speed", 0.03}, {"profile", 1}});
  CHECK(trapezoid.duration() == doctest::Approx(2.5));  // 20 % of the time up, 20 % down: mean 0.8 of the largest
  CHECK(trapezoid.raw(1.25).velocity[2] == doctest::Approx(-0.03));
  CHECK(trapezoid.raw(0.25).velocity[2] == doctest::Approx(-0.015));
  const LoadedMotion cosine(library, id, {{"displacement_z", -0.06}, {"speed", 0.03}, {"profile", 2}});
  CHECK(cosine.duration() == doctest::Approx(pi));
  CHECK(cosine.raw(pi / 2).velocity[2] == doctest::Approx(-0.03));
}

TEST_CASE("parameters that contradict each other are refused") {
  CHECK(refusal(library, id, {{"speed", 0.03}, {"duration", 2}}) ==
        "speed: 0.03 m/s and duration 2 s are given both; give one of them");
  CHECK(refusal(library, id, {{"displacement_z", 0}}) ==
        "displacement: [0, 0, 0] is no way to go; give at least one component that is not 0");
  CHECK(refusal(library, id, {{"hold", 1}}).find("hold: 1 s has no effect") == 0);
}
