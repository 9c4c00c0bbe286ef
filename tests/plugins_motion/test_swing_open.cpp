// calx.open-close: butterfly valve and swing gate.
#include "motion_checks.hpp"

using namespace calx_test;

namespace {
const char library[] = "calx_swing_open", id[] = "calx.open-close";
}

TEST_CASE("velocity is the derivative of the pose for every profile and ending") {
  for (const double profile : {0.0, 1.0, 2.0}) {
    const std::map<std::string, double> given = {{"profile", profile}, {"acceleration_share", 0.3}, {"angle_from", 0.2},
                                                 {"angle_to", -3.9},   {"duration", 0.5},           {"origin_z", 0.64},
                                                 {"axis_x", 0.4}};
    check_motion(LoadedMotion(library, id, given), {0.5}, 0.7);
    auto returning = given;
    returning["then"] = 1;
    returning["hold"] = 0.25;
    const LoadedMotion m(library, id, returning);
    CHECK(m.duration() == doctest::Approx(1.25));
    check_motion(m, {0.5, 0.75, 1.25}, 1.4);
    CHECK(m.raw(0.6).angle == -3.9);
    CHECK(m.raw(1.3).angle == 0.2);
  }
}

TEST_CASE("a butterfly valve opens from 0 to 90 degrees and stays") {
  const LoadedMotion m(library, id);
  CHECK(m.raw(-1).angle == 0);
  CHECK(m.raw(1.0 / 3).angle == doctest::Approx(pi / 3));
  CHECK(m.raw(0.5).angle == pi / 2);
  CHECK(m.raw(0.25).cycle == 0);
  CHECK(m.duration() == 0.5);
  CHECK(m.top_speed(0.0245) == doctest::Approx(0.0245 * pi));
}

TEST_CASE("before its start the part stands at angle_from") {
  const LoadedMotion m(library, id, {{"angle_from", pi / 2}, {"angle_to", 0}});
  CHECK(m.pose(0).to_world({0, 0, 1}).x == doctest::Approx(1));
  CHECK(m.raw(9).quaternion[0] == 1);
}

TEST_CASE("a hold without return is refused") {
  CHECK(refusal(library, id, {{"hold", 0.5}}) ==
        "hold: 0.5 s has no effect while \"then\" is \"stay\"; remove it or write \"then\": \"return\"");
}
