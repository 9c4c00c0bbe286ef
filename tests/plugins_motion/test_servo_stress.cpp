// calx.servo-stress on a spring: pace, steps, limits, state.
#include <algorithm>
#include <cmath>
#include <memory>

#include "servo_bench.hpp"

using namespace calx_test;

namespace {

const char library[] = "calx_servo_stress", id[] = "calx.servo-stress";
const double k = 1000;  // N/m, of the spring

std::map<std::string, double> along_x(std::map<std::string, double> more) {
  std::map<std::string, double> given = {
      {"axis_x", 2}, {"axis_z", 0}, {"control", 1}, {"damping", 100}, {"speed_limit", 10}};
  for (const auto& one : more) given[one.first] = one.second;
  return given;
}
void push(LoadedServo& servo) { REQUIRE(servo.advance(-k * servo.pose().displacement[0]) == CALX_OK); }

}  // namespace

// v = (F - k x) / c, stepped by dt: the force left over shrinks by 1 - k dt / c in each step.
TEST_CASE("on a spring the load nears its target by the same share in every step") {
  LoadedServo servo(library, id, along_x({}), R"({"steps": [5]})");
  for (int n = 1; n <= 500; ++n) {
    push(servo);
    const double left = 5 - k * servo.pose().displacement[0];
    CHECK(left == doctest::Approx(5 * std::pow(1 - k * 1e-3 / 100, n)).epsilon(1e-10));
  }
  CHECK(servo.pose().quaternion[0] == 1);
  CHECK(servo.pose().displacement[2] == 0);
}

TEST_CASE("a stress acts on its area, and the speed stays below its limit") {
  LoadedServo servo(library, id, along_x({{"control", 0}, {"area", 0.01}, {"speed_limit", 0.02}}),
                    R"({"steps": [500]})");
  double fastest = 0;
  for (int n = 0; n < 2000; ++n) {
    const double before = servo.pose().displacement[0];
    push(servo);
    const calx_pose now = servo.pose();
    // The velocity told to contacts is that of the way gone.
    CHECK(now.displacement[0] - before == doctest::Approx(now.velocity[0] * 1e-3).epsilon(1e-9));
    fastest = std::max(fastest, std::fabs(now.velocity[0]));
  }
  CHECK(fastest == 0.02);
  CHECK(servo.servo()->top_speed(servo.instance(), 7) == 0.02);
  CHECK(servo.pose().displacement[0] == doctest::Approx(500 * 0.01 / k).epsilon(1e-6));
}

TEST_CASE("far from the spring the part comes at its approach speed, and never again once it has touched") {
  LoadedServo servo(library, id, along_x({{"approach_speed", 0.5}, {"speed_limit", 0.01}}), R"({"steps": [5]})");
  for (int n = 0; n < 20; ++n) {
    REQUIRE(servo.advance(0) == CALX_OK);
    CHECK(servo.pose().velocity[0] == 0.5);
  }
  CHECK(servo.servo()->top_speed(servo.instance(), 1) == 0.5);
  REQUIRE(servo.advance(-0.06) == CALX_OK);
  CHECK(servo.pose().velocity[0] == 0.01);
  REQUIRE(servo.advance(0) == CALX_OK);
  CHECK(servo.pose().velocity[0] == 0.01);
}

TEST_CASE("steps of given times end on the time step, and the last one stays") {
  LoadedServo servo(library, id, along_x({{"ends", 1}}), R"({"steps": [5, 2, 8], "times": [0.3, 0.1, 0.2]})");
  std::vector<int> ends;
  double done = 0;
  for (int n = 1; n <= 1000; ++n) {
    push(servo);
    if (std::floor(servo.pose().cycle) > done) ends.push_back(n), done = std::floor(servo.pose().cycle);
    if (n == 350) CHECK(servo.pose().cycle == doctest::Approx(1.5));
  }
  CHECK(ends == std::vector<int>{300, 400, 600});
  CHECK(servo.pose().cycle == 3);
  CHECK(servo.pose().displacement[0] * k == doctest::Approx(8).epsilon(0.02));
}

TEST_CASE("a step that settles ends when load and speed are quiet for the hold") {
  LoadedServo servo(
      library, id,
      along_x({{"tolerance", 0.01}, {"hold_speed", 1e-3}, {"hold", 0.05}, {"smoothing", 0}, {"step_time", 10}}),
      R"({"steps": [5, 10]})");
  // Left over below 1 % of 5 N: 0.99^n < 0.01, n = 459; the speed 5 N 0.99^n / c < 1e-3 m/s: n = 390. Then 50 ms more.
  int end = 0;
  for (int n = 1; n <= 1000 && end == 0; ++n) {
    push(servo);
    if (servo.pose().cycle >= 1) end = n;
  }
  CHECK(std::abs(end - (459 + 1 + 50)) <= 1);
}

TEST_CASE("a step that never settles ends after its time") {
  LoadedServo servo(library, id, along_x({{"hold_speed", 1e-12}, {"step_time", 0.2}}), R"({"steps": [5, 6]})");
  for (int n = 1; n <= 199; ++n) push(servo);
  CHECK(servo.pose().cycle < 1);
  push(servo);
  CHECK(servo.pose().cycle == 1);
}

TEST_CASE("a part that nothing holds ends the run and says so") {
  LoadedServo servo(library, id, along_x({{"travel_limit", 0.03}, {"speed_limit", 0.01}}), R"({"steps": [5]})");
  calx_status status = CALX_OK;
  int steps = 0;
  for (; status == CALX_OK && steps < 10000; ++steps) status = servo.advance(0);
  CHECK(status == CALX_E_CONFIG);
  CHECK(std::abs(steps - 3001) <= 1);
  CHECK(servo.message().find("travel_limit: the part has gone 0.03 m") == 0);
  CHECK(servo.message().find("nothing holds it") != std::string::npos);
  CHECK(servo.servo()->reach(servo.instance()) == 0.03);
}

TEST_CASE("the state is saved and given back to the bit, and bad bytes are refused") {
  const auto make = [] {
    return std::make_unique<LoadedServo>(library, id, along_x({{"hold", 0.01}}), R"({"steps": [5, 2, 8, 3, 1]})");
  };
  check_saved_state(make, push, 700);
}

TEST_CASE("bad parameters are refused") {
  CHECK(refusal(library, id, {}, "{}").find("steps: a list of at least one stress") == 0);
  CHECK(refusal(library, id, {{"damping", 1}}, R"({"steps": [5]})") ==
        "area: 0 m^2; a stress needs the area it acts on");
  CHECK(refusal(library, id, along_x({}), R"({"steps": [5, 6], "times": [1]})") ==
        "times: 1 times for 2 steps; give one for each");
  CHECK(refusal(library, id, along_x({{"axis_x", 0}}), R"({"steps": [5]})").find("axis: [0, 0, 0] has no direction") ==
        0);
}
