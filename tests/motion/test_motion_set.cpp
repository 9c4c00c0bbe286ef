// Poses, composition, start times and checkpoints of MotionSet, driven by motions written here against the C table.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "base/error.hpp"
#include "motion/motion.hpp"
#include "support/memory_state.hpp"

// What a plugin would keep: here a turn about an axis and a displacement, each a polynomial of time up to an end.
struct calx_instance {
  calx::Vec3 pivot, axis, way;
  double angle_rate = 0, angle_bend = 0;  // angle = rate t + bend t^2
  double way_rate = 0, way_bend = 0;
  double end = std::numeric_limits<double>::infinity();
  calx_status status = CALX_OK;
  double quaternion_scale = 1;
};

namespace {

using calx::Error;
using calx::Fault;
using calx::MotionSet;
using calx::Pose;
using calx::Vec3;

void put(double (&to)[3], const Vec3& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

calx_status pose(const calx_instance* m, double t, calx_pose* out) {
  const double u = t < 0 ? 0 : t > m->end ? m->end : t;
  const bool moves = t > 0 && t < m->end;
  std::memset(out, 0, sizeof *out);
  const double angle = m->angle_rate * u + m->angle_bend * u * u, way = m->way_rate * u + m->way_bend * u * u;
  put(out->pivot, m->pivot);
  put(out->displacement, way * m->way);
  out->quaternion[0] = m->quaternion_scale * std::cos(angle / 2);
  for (int k = 0; k < 3; ++k) out->quaternion[k + 1] = m->quaternion_scale * std::sin(angle / 2) * m->axis[k];
  if (moves) {
    put(out->velocity, (m->way_rate + 2 * m->way_bend * u) * m->way);
    put(out->spin, (m->angle_rate + 2 * m->angle_bend * u) * m->axis);
  }
  out->angle = angle;
  out->cycle = u;
  return m->status;
}
double duration(const calx_instance* m) { return m->end; }
double top_speed(const calx_instance* m, double r) {
  return std::fabs(m->angle_rate) * r + std::fabs(m->way_rate) * norm(m->way);
}
const calx_motion table = {sizeof(calx_motion), CALX_ABI_DRAFT, pose, duration, top_speed};

calx_instance turning(const Vec3& pivot, const Vec3& axis, double rate, double bend = 0) {
  calx_instance m;
  m.pivot = pivot;
  m.axis = normalized(axis);
  m.angle_rate = rate;
  m.angle_bend = bend;
  return m;
}
calx_instance sliding(const Vec3& way, double rate, double bend = 0) {
  calx_instance m;
  m.axis = {0, 0, 1};
  m.way = way;
  m.way_rate = rate;
  m.way_bend = bend;
  return m;
}

void check_near(const Vec3& a, const Vec3& b, double tolerance) { CHECK(norm(a - b) <= tolerance); }

// Velocity of material points against the central difference of where the pose puts them.
void check_velocity(const MotionSet& set, int motion, double t) {
  const Vec3 points[] = {{0.3, -0.2, 0.1}, {-1.1, 0.4, 0.7}, {0, 0, 0}};
  const double h = 1e-5;
  const Pose now = set.pose(motion, t), before = set.pose(motion, t - h), after = set.pose(motion, t + h);
  for (const Vec3& p : points) {
    const Vec3 difference = (after.to_world(p) - before.to_world(p)) / (2 * h);
    // Cut-off h^2/6 of the third derivative (some 10 /s^3) and rounding 1e-16/h: both near 1e-10.
    check_near(now.velocity_at(now.to_world(p)), difference, 1e-8);
  }
  check_near(now.velocity, (after.centre - before.centre) / (2 * h), 1e-8);
}

std::string message_of(Fault fault, const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    CHECK(e.fault() == fault);
    return e.what();
  }
  FAIL("no error");
  return "";
}

}  // namespace

TEST_CASE("a quarter turn about a pivot off the origin moves points as drawn on paper") {
  const double pi = 3.14159265358979323846;
  const calx_instance m = turning({1, 0, 0}, {0, 0, 1}, pi / 2);
  MotionSet set;
  const int k = set.add("turn", &table, &m, false, -1);
  const Pose p = set.pose(k, 1);
  check_near(p.to_world({2, 0, 0}), {1, 1, 0}, 1e-15);
  check_near(p.to_part({1, 1, 0}), {2, 0, 0}, 1e-15);
  check_near(p.centre, {1, 0, 0}, 0);
  CHECK(p.angle == doctest::Approx(pi / 2).epsilon(1e-15));
  check_near(p.velocity_at({1, 1, 0}), {-pi / 2, 0, 0}, 1e-15);
}

TEST_CASE("a pure displacement is free of rounding, and no motion is the identity") {
  calx_instance m = sliding({0.1, 0, -0.3}, 1);
  m.pivot = {0.7, 0.9, 1.3};
  MotionSet set;
  const int k = set.add("slide", &table, &m, false, -1);
  const Pose p = set.pose(k, 1);
  CHECK(p.shift.x == 0.1);  // bits meant: the shift is the displacement itself
  CHECK(p.shift.z == -0.3);
  const Pose none = set.pose(-1, 3);
  check_near(none.to_world({1, 2, 3}), {1, 2, 3}, 0);
  CHECK_FALSE(set.moving(-1, 0));
  CHECK(set.top_speed(-1, 1) == 0);
}

TEST_CASE("velocities of composed motions are the derivative of the composed pose") {
  const calx_instance rotor = turning({0.2, 0.1, -0.4}, {1, 2, 0.5}, 1.7, -0.3);
  calx_instance arm = turning({-0.5, 0.3, 0.2}, {0.2, -1, 0.4}, -0.9, 0.2);
  arm.way = {0.3, 0.2, -0.1};
  arm.way_rate = 0.5;
  const calx_instance lift = sliding({0.1, 0.3, 0.9}, 0.4, 0.7);
  MotionSet set;
  const int outer = set.add("lift", &table, &lift, false, -1);
  const int middle = set.add("arm", &table, &arm, false, outer);
  const int inner = set.add("rotor", &table, &rotor, false, middle);
  for (const double t : {0.1, 0.77, 1.9, 3.3})
    for (const int k : {outer, middle, inner}) check_velocity(set, k, t);
}

TEST_CASE("the outer motion is applied on top of the inner one") {
  const double pi = 3.14159265358979323846;
  const calx_instance slide = sliding({1, 0, 0}, 1), swing = turning({0, 0, 0}, {0, 0, 1}, pi / 2);
  MotionSet set;
  const int outer = set.add("swing", &table, &swing, false, -1);
  const int inner = set.add("slide", &table, &slide, false, outer);
  // After 1 s the slide has moved the point to (2, 0, 0), then the swing turns that to (0, 2, 0).
  check_near(set.pose(inner, 1).to_world({1, 0, 0}), {0, 2, 0}, 1e-15);
  CHECK(set.pose(inner, 1).angle == 0);  // the slide's own
}

TEST_CASE("a waiting motion rests until its start and counts time from there") {
  calx_instance m = sliding({1, 0, 0}, 2);
  m.end = 3;
  MotionSet set;
  const int k = set.add("gate", &table, &m, true, -1);
  CHECK(set.find("gate") == k);
  CHECK(set.find("gat") == -1);
  CHECK(set.pose(k, 5).shift.x == 0);
  CHECK_FALSE(set.started(k));
  CHECK_FALSE(set.moving(k, 5));
  set.start(k, 10);
  set.start(k, 11);  // ignored
  CHECK(set.start_time(k) == 10);
  CHECK(set.pose(k, 11.5).shift.x == 3);
  CHECK(set.pose(k, 11.5).velocity.x == 2);
  CHECK(set.moving(k, 12.9));
  CHECK_FALSE(set.moving(k, 13));
  CHECK(set.pose(k, 20).shift.x == 6);
  CHECK(set.pose(k, 20).velocity.x == 0);
}

TEST_CASE("a part moves as long as what carries it moves") {
  calx_instance slide = sliding({1, 0, 0}, 1), lift = sliding({0, 0, 1}, 1);
  slide.end = 1;
  lift.end = 2;
  MotionSet set;
  const int outer = set.add("lift", &table, &lift, false, -1);
  const int inner = set.add("slide", &table, &slide, false, outer);
  CHECK(set.moving(inner, 1.5));
  CHECK_FALSE(set.moving(inner, 2));
}

TEST_CASE("top speed bounds the speed of every point, carrying motions included") {
  calx_instance slide = sliding({1, 0, 0}, 0.5), swing = turning({-1, 0, 0}, {0, 0, 1}, 2);
  slide.end = 3;
  MotionSet set;
  const int outer = set.add("swing", &table, &swing, false, -1);
  const int inner = set.add("slide", &table, &slide, false, outer);
  // The pivot ends 1.5 m out: 2.5 m from the swing's axis, plus the radius 0.1 m, at 2 rad/s, plus 0.5 m/s.
  CHECK(set.top_speed(inner, 0.1) == doctest::Approx(0.5 + 2 * 2.6));
  CHECK(set.top_speed(outer, 0.1) == doctest::Approx(0.2));
  const Pose p = set.pose(inner, 2.999);
  const double speed = norm(p.velocity_at(p.to_world({0.1, 0, 0})));
  CHECK(speed <= set.top_speed(inner, 0.1));
  CHECK(speed > 0.9 * set.top_speed(inner, 0.1));
}

TEST_CASE("starts survive a checkpoint with the same bits") {
  const calx_instance m = turning({0.3, 0, 0}, {0, 1, 0}, 1.3);
  MotionSet set, again;
  for (MotionSet* s : {&set, &again}) {
    s->add("a", &table, &m, true, -1);
    s->add("b", &table, &m, true, 0);
    s->add("c", &table, &m, false, -1);
  }
  set.start(1, 0.1 + 0.2);
  calx::MemoryState state;
  set.save(state);
  again.load(state);
  for (int k = 0; k < 3; ++k) {
    CHECK(again.started(k) == set.started(k));
    CHECK(again.start_time(k) == set.start_time(k));
    const Pose p = set.pose(k, 2.7), q = again.pose(k, 2.7);
    CHECK(std::memcmp(&p, &q, sizeof p) == 0);
  }
  CHECK(state.units["motions/start"] == "s");
}

TEST_CASE("a checkpoint of other motions is refused by name") {
  const calx_instance m = turning({}, {0, 1, 0}, 1);
  MotionSet set, other;
  set.add("rotor", &table, &m, false, -1);
  other.add("gate", &table, &m, false, -1);
  calx::MemoryState state;
  set.save(state);
  const std::string text = message_of(Fault::files, [&] { other.load(state); });
  CHECK(text.find("the checkpoint holds the motions [rotor], the case has [gate]") != std::string::npos);
}

TEST_CASE("motions that carry each other are refused") {
  const calx_instance m = turning({}, {0, 1, 0}, 1);
  MotionSet set;
  set.add("a", &table, &m, false, 1);  // carried by the next one
  const std::string text = message_of(Fault::settings, [&] { set.add("b", &table, &m, false, 0); });
  CHECK(text.find("\"b\" by \"a\" by \"b\"") != std::string::npos);
}

TEST_CASE("a plugin that fails or deforms the part is named with the time") {
  calx_instance m = turning({}, {0, 1, 0}, 1);
  MotionSet set;
  const int k = set.add("rotor", &table, &m, false, -1);
  m.status = CALX_E_INTERNAL;
  CHECK(message_of(Fault::plugin, [&] { set.pose(k, 2.5); }) ==
        "motion \"rotor\" at t = 2.5 s: the plugin gives no pose and returns status -100");
  m.status = CALX_OK;
  m.quaternion_scale = 1.001;
  CHECK(message_of(Fault::plugin, [&] { set.pose(k, 2.5); }).find("squared length of the quaternion 1.002") !=
        std::string::npos);
  m.quaternion_scale = 1;
  m.angle_rate = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(set.pose(k, 2.5), Error);
  CHECK_THROWS_AS(set.pose(7, 0), Error);
}
