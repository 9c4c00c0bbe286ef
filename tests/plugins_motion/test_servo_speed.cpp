// calx.servo-speed on a spring: legs, bounds, state.
#include <cmath>
#include <memory>

#include "servo_bench.hpp"

using namespace calx_test;

namespace {

const char library[] = "calx_servo_speed", id[] = "calx.servo-speed";
const double k = 1000;  // N/m, of the spring
const char legs[] = R"({"legs": [{"speed": 0.1, "duration": 0.2}, {"speed": -0.05, "duration": 0.5, "stop_at": 4},
                                 {"speed": 0.1, "duration": 0.1, "stop_at": 9}]})";

void push(LoadedServo& servo) { REQUIRE(servo.advance(-k * servo.pose().displacement[0]) == CALX_OK); }

}  // namespace

TEST_CASE("legs run at their speed, stop at their bound and last their time") {
  LoadedServo servo(library, id, {{"smoothing", 0}}, legs);
  double x[1200];
  for (int n = 1; n < 1200; ++n) {
    push(servo);
    x[n] = servo.pose().displacement[0];
    if (n == 200) CHECK(servo.pose().cycle == doctest::Approx(1).epsilon(1e-12));
    if (n == 699) CHECK(servo.pose().cycle < 2 - 1e-3);
    if (n == 700) CHECK(servo.pose().cycle == doctest::Approx(2).epsilon(1e-12));
    if (n == 800) CHECK(servo.pose().cycle == 3);
  }
  CHECK(x[100] == doctest::Approx(0.01));
  CHECK(x[200] == doctest::Approx(0.02));
  // Back at 0.05 m/s until the spring carries 4 N; the bound is met in the step after, within 0.05 mm.
  CHECK(std::fabs(x[699] - 0.004) <= 1.01 * 0.05e-3);
  CHECK(x[699] == x[600]);
  CHECK(std::fabs(x[800] - 0.009) <= 1.01 * 0.1e-3);
  CHECK(x[1199] == x[800]);
  CHECK(servo.pose().velocity[0] == 0);
  CHECK(servo.servo()->top_speed(servo.instance(), 3) == 0.1);
}

TEST_CASE("a leg without a bound goes on whatever the load") {
  LoadedServo servo(library, id, {}, R"({"legs": [{"speed": 0.1, "duration": 0.2}]})");
  for (int n = 0; n < 200; ++n) REQUIRE(servo.advance(-1e6) == CALX_OK);
  CHECK(servo.pose().displacement[0] == doctest::Approx(0.02));
}

TEST_CASE("the way has a limit") {
  LoadedServo servo(library, id, {{"travel_limit", 0.005}}, R"({"legs": [{"speed": -0.1, "duration": 0.2}]})");
  calx_status status = CALX_OK;
  for (int n = 0; n < 200 && status == CALX_OK; ++n) status = servo.advance(0);
  CHECK(status == CALX_E_CONFIG);
  CHECK(servo.message().find("travel_limit: the part has gone 0.005 m") == 0);
}

TEST_CASE("the state is saved and given back to the bit, and bad bytes are refused") {
  check_saved_state([] { return std::make_unique<LoadedServo>(library, id, std::map<std::string, double>{}, legs); },
                    push, 420);
}

TEST_CASE("bad parameters are refused") {
  CHECK(refusal(library, id, {}, "{}") == "legs: a list of at least one leg is needed");
  CHECK(refusal(library, id, {{"axis_x", 0}}, legs).find("axis: [0, 0, 0] has no direction") == 0);
}
