// calx.motion-table: measured motions as rows.
#include "motion_checks.hpp"

using namespace calx_test;

namespace {
const char library[] = "calx_motion_table", id[] = "calx.motion-table";
const char rows[] = "{\"rows\": [[0, 0.1, 0], [0.25, 0.4, 0.2], [0.75, 0.4, 0.5], [1.0, -2.5, 0.1]]}";
const char closed[] = "{\"rows\": [[0, 0, 0], [0.25, 1, 0.2], [0.625, 4, 0.1], [1.0, 0, 0]]}";
}  // namespace

TEST_CASE("velocity is the derivative of the pose for lines and cubics") {
  for (const double curve : {0.0, 1.0})
    for (const double cycles : {1.0, 3.0}) {
      const LoadedMotion m(library, id,
                           {{"curve", curve}, {"cycles", cycles}, {"origin_x", 0.3}, {"axis_y", 1}, {"direction_x", 2}},
                           rows);
      CHECK(m.duration() == cycles);
      check_motion(m, {0.25, 0.75, 1, 1.25, 1.75, 2, 2.25, 2.75, 3}, cycles + 0.2);
    }
}

TEST_CASE("lines go through the rows and between them") {
  const LoadedMotion m(library, id, {}, rows);
  CHECK(m.raw(0).angle == 0.1);
  CHECK(m.raw(0.125).angle == doctest::Approx(0.25));
  CHECK(m.raw(0.125).displacement[2] == doctest::Approx(0.1));
  CHECK(m.raw(0.125).velocity[2] == doctest::Approx(0.8));
  CHECK(m.raw(0.125).spin[2] == doctest::Approx(1.2));
  CHECK(m.raw(0.5).spin[2] == 0);
  CHECK(m.raw(0.25).angle == 0.4);
  CHECK(m.raw(5).angle == -2.5);
  CHECK(m.raw(5).displacement[2] == 0.1);
}

TEST_CASE("cubics pass the rows without a jump in speed and never overshoot") {
  const LoadedMotion m(library, id, {{"curve", 1}}, rows);
  for (const double t : {0.25, 0.75}) {
    CHECK(m.raw(t).angle == doctest::Approx(0.4).epsilon(1e-14));
    CHECK(m.raw(t - 1e-9).spin[2] == doctest::Approx(m.raw(t + 1e-9).spin[2]).epsilon(1e-6));
    CHECK(m.raw(t - 1e-9).velocity[2] == doctest::Approx(m.raw(t + 1e-9).velocity[2]).epsilon(1e-6));
  }
  for (int k = 0; k <= 1000; ++k) {
    const calx_pose p = m.raw(k / 1000.0);
    REQUIRE(p.angle <= 0.4 + 1e-15);
    REQUIRE(p.angle >= -2.5);
    REQUIRE(p.displacement[2] <= 0.5 + 1e-15);
    REQUIRE(p.displacement[2] >= -1e-15);
  }
}

TEST_CASE("a closed table repeats with the same bits, an open one goes on from its end") {
  const LoadedMotion m(library, id, {{"cycles", 0}}, closed);
  CHECK(std::isinf(m.duration()));
  for (int k = 1; k < 128; ++k) {
    calx_pose now = m.raw(k / 128.0), later = m.raw(k / 128.0 + 1000);
    CHECK(later.cycle == now.cycle + 1000);
    now.cycle = later.cycle = 0;
    REQUIRE(same_bits(now, later));
  }
  const LoadedMotion open(library, id, {{"cycles", 3}}, rows);
  CHECK(open.raw(1.125).angle == doctest::Approx(0.25 - 2.6));
  CHECK(open.raw(3).angle == doctest::Approx(0.1 - 3 * 2.6));
  CHECK(open.raw(3).displacement[2] == doctest::Approx(0.3));
  CHECK(open.raw(2.5).cycle == 2.5);
  CHECK(open.raw(7).cycle == 3);
}

TEST_CASE("rows in degrees turn by degrees") {
  const LoadedMotion m(library, id, {}, "{\"rows_deg\": [[0, 0, 0], [2, 180, 0.5]]}");
  CHECK(m.raw(2).angle == pi);
  CHECK(m.raw(1).angle == doctest::Approx(pi / 2));
}

TEST_CASE("wrong rows are named") {
  const auto text = [](const char* json) { return refusal(library, id, {}, json); };
  CHECK(text("{}") ==
        "rows: missing; give a list of [time s, angle rad, displacement m], or rows_deg with angles in degrees");
  CHECK(text("{\"rows\": [[0,0,0]]}") == "rows: needs a list of at least two rows [time, angle, displacement]");
  CHECK(text("{\"rows\": [[0,0,0],[1,2]]}") == "rows/1: [1,2] is no row; write [time, angle, displacement]");
  CHECK(text("{\"rows\": [[0,0,0],[1,2,\"x\"]]}") == "rows/1: \"x\" is no number; write [time, angle, displacement]");
  CHECK(text("{\"rows_deg\": [[0.5,0,0],[1,2,3]]}") == "rows_deg/0: time 0.5 s; the first row is the rest at time 0");
  CHECK(text("{\"rows\": [[0,0,0],[1,2,3],[1,2,3]]}") == "rows/2: time 1 s does not rise above 1 s of the row before");
  CHECK(text("{\"rows\": [[0,0,0],[1,2,3]], \"rows_deg\": []}") ==
        "rows and rows_deg are given both; give one of them");
  CHECK(text("nonsense") == "rows: the parameters are no JSON object");
}
