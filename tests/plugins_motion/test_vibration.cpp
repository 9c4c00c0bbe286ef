// calx.vibration: vibratory compaction.
#include "motion_checks.hpp"

using namespace calx_test;

namespace {
const char library[] = "calx_vibration", id[] = "calx.vibration";
}

TEST_CASE("velocity is the derivative of the pose with and without ramp and end") {
  check_motion(LoadedMotion(library, id, {{"frequency", 3}, {"direction_x", 1}, {"phase", 0.4}}), {}, 0.9);
  check_motion(LoadedMotion(library, id, {{"frequency", 3}, {"duration", 1}, {"phase", 2.4}}), {1}, 1.2);
  check_motion(LoadedMotion(library, id, {{"frequency", 5}, {"duration", 2}, {"ramp", 0.5}, {"phase", 1}}),
               {0.5, 1.5, 2}, 2.2);
}

TEST_CASE("50 Hz and 0.5 mm reach 5 g") {
  const LoadedMotion m(library, id);
  CHECK(m.raw(0.005).displacement[2] == doctest::Approx(0.0005));  // a quarter period
  CHECK(m.raw(0.015).displacement[2] == doctest::Approx(-0.0005));
  const double h = 1e-5;
  const double acceleration = (m.raw(0.015 + h).velocity[2] - m.raw(0.015 - h).velocity[2]) / (2 * h);
  CHECK(acceleration / 9.81 == doctest::Approx(5.03).epsilon(0.001));
  CHECK(m.top_speed(3) == doctest::Approx(0.157).epsilon(0.001));
  CHECK(std::isinf(m.duration()));
}

TEST_CASE("a whole period later the pose has the same bits, after hours too") {
  const LoadedMotion m(library, id, {{"frequency", 64}, {"phase", 0.3}});
  for (int k = 1; k < 100; ++k) {
    const double t = k / 4096.0;
    calx_pose now = m.raw(t), later = m.raw(t + 8192);
    CHECK(later.cycle == now.cycle + 64 * 8192);
    now.cycle = later.cycle = 0;
    REQUIRE(same_bits(now, later));
  }
}

TEST_CASE("a part with a phase rests where its vibration begins, and with a ramp where it is drawn") {
  const LoadedMotion m(library, id, {{"phase", pi / 2}});
  CHECK(m.raw(0).displacement[2] == 0.0005);
  CHECK(m.raw(1e-9).displacement[2] == doctest::Approx(0.0005));
  const LoadedMotion ramped(library, id, {{"phase", pi / 2}, {"ramp", 0.1}, {"duration", 1.003}});
  CHECK(ramped.raw(0).displacement[2] == 0);
  CHECK(ramped.raw(0.05).displacement[2] == doctest::Approx(-0.00025).epsilon(1e-6));  // 2.5 periods, half amplitude
  CHECK(ramped.raw(2).displacement[2] == 0);
}

TEST_CASE("a ramp longer than half of the duration, and no direction, are refused") {
  CHECK(refusal(library, id, {{"duration", 1}, {"ramp", 0.6}}) ==
        "ramp: 0.6 s, twice, is longer than the duration 1 s; it can be half of the duration at most");
  CHECK(refusal(library, id, {{"direction_z", 0}}) ==
        "direction: [0, 0, 0] has no direction; give a vector of any length but 0");
}
