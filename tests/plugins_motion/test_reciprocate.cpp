// calx.reciprocate: the rotor of PROCESS.md section 3 and its variants.
#include "motion_checks.hpp"

using namespace calx_test;

namespace {
const char library[] = "calx_reciprocate", id[] = "calx.reciprocate";
// A period that is a binary number, so that adding it rounds nothing away.
const std::map<std::string, double> dyadic = {{"stroke", 0.1875},  {"dwell", 0.0625}, {"origin_x", 0.0577},
                                              {"origin_z", 0.535}, {"axis_x", 1},     {"axis_z", -2}};
}  // namespace

TEST_CASE("velocity is the derivative of the pose for every profile") {
  for (const double profile : {0.0, 1.0, 2.0})
    for (const double swing : {pi, -4.5, 7.0}) {
      auto given = dyadic;
      given["profile"] = profile;
      given["swing"] = swing;
      given["cycles"] = 2;
      const LoadedMotion m(library, id, given);
      check_motion(m, {0.1875, 0.25, 0.4375, 0.5, 0.6875, 0.75, 0.9375}, 1.1);
    }
}

TEST_CASE("a stroke turns at constant rate, rests, and returns") {
  const LoadedMotion m(library, id, {{"cycles", 40}});  // 0.20 s strokes, 0.08 s dwell: period 0.56 s
  CHECK(m.duration() == doctest::Approx(22.4));
  CHECK(m.raw(0.05).angle == doctest::Approx(pi / 4));
  CHECK(m.raw(0.05).spin[1] == doctest::Approx(pi / 0.2));
  CHECK(m.raw(0.24).angle == pi);
  CHECK(m.raw(0.24).spin[1] == 0);
  CHECK(m.raw(0.38).angle == doctest::Approx(pi / 2));
  CHECK(m.raw(0.38).spin[1] == doctest::Approx(-pi / 0.2));
  CHECK(m.raw(0.50).angle == 0);
  // Tip speed of the base set: 25 mm at 180 degrees in 0.20 s, 0.39 m/s.
  CHECK(m.top_speed(0.025) == doctest::Approx(0.3927).epsilon(1e-4));
}

TEST_CASE("a positive swing about +y is clockwise seen from -y") {
  const LoadedMotion m(library, id);
  // Front view: x to the right, z up. The top goes to the right.
  const calx::Vec3 p = m.pose(0.1).to_world({0, 0, 1});
  CHECK(p.x == doctest::Approx(1));
  CHECK(std::fabs(p.z) < 1e-15);
  const LoadedMotion back(library, id, {{"swing", -pi}});
  CHECK(back.pose(0.1).to_world({0, 0, 1}).x == doctest::Approx(-1));
}

TEST_CASE("at exactly 180 degrees the quaternion is the half turn, and beyond it stays continuous") {
  const LoadedMotion m(library, id);
  const calx_pose half = m.raw(0.22);
  CHECK(std::fabs(half.quaternion[0]) < 1e-16);
  CHECK(half.quaternion[2] == 1);
  const calx::Vec3 p = m.pose(0.22).to_world({0.3, 0.2, 0.1});
  CHECK(p.x == doctest::Approx(-0.3).epsilon(1e-15));
  CHECK(p.y == 0.2);
  CHECK(p.z == doctest::Approx(-0.1).epsilon(1e-15));
  const LoadedMotion far(library, id, {{"swing", 1.9 * pi}});
  CHECK(far.raw(0.22).quaternion[0] == doctest::Approx(std::cos(0.95 * pi)));  // negative: the sign is kept
}

TEST_CASE("a whole period later the pose has the same bits") {
  for (const double profile : {0.0, 1.0, 2.0}) {
    auto given = dyadic;
    given["profile"] = profile;
    const LoadedMotion m(library, id, given);
    CHECK(std::isinf(m.duration()));
    for (int k = 1; k < 500; ++k) {
      const double t = k / 1024.0;
      calx_pose now = m.raw(t), later = m.raw(t + 4096 * 0.5);
      CHECK(later.cycle == doctest::Approx(now.cycle + 4096).epsilon(1e-15));
      now.cycle = later.cycle = 0;
      REQUIRE(same_bits(now, later));
    }
  }
}

TEST_CASE("cycle counts completed cycles and ends at their number") {
  const LoadedMotion m(library, id, {{"cycles", 3}});
  CHECK(m.raw(0).cycle == 0);
  CHECK(m.raw(0.14).cycle == doctest::Approx(0.25));
  CHECK(m.raw(0.559).cycle < 1);
  CHECK(m.raw(0.561).cycle > 1);
  CHECK(m.raw(1.679).cycle < 3);
  CHECK(m.raw(1.681).cycle == 3);
  CHECK(m.raw(99).cycle == 3);
  CHECK(m.raw(99).angle == 0);
  double last = 0;
  for (int k = 0; k < 20000; ++k) {
    const double cycle = m.raw(k * 1e-4).cycle;
    REQUIRE(cycle >= last);
    last = cycle;
  }
}

TEST_CASE("every stroke but the first begins at full rate, the first from rest") {
  const LoadedMotion m(library, id, {{"stroke", 0.25}, {"dwell", 0.25}});
  CHECK(m.raw(0).spin[1] == 0);
  CHECK(m.raw(1).spin[1] == doctest::Approx(4 * pi));
}

TEST_CASE("an axis without direction is refused") {
  CHECK(refusal(library, id, {{"axis_y", 0}}) == "axis: [0, 0, 0] has no direction; give a vector of any length but 0");
}
