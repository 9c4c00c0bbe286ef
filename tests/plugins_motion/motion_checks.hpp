// motion_checks.hpp: what every motion plugin must keep, whatever it does: velocity is the derivative of the pose, the
// same time gives the same bits, rest before the start and after the end, and a true bound on the speed.
#pragma once
#include <cmath>
#include <cstring>
#include <limits>

#include "loaded_plugin.hpp"
#include "motion/motion.hpp"

namespace calx_test {

const double pi = 3.14159265358979323846;

class LoadedMotion : public LoadedPlugin {
 public:
  LoadedMotion(const std::string& library, const std::string& id, const std::map<std::string, double>& given = {},
               const std::string& json = "{}")
      : LoadedPlugin(library, id, given, json), table_(table<calx_motion>(CALX_MOTION)) {
    CHECK(std::string(descriptor().kind) == CALX_MOTION);
    index_ = set_.add("test", table_, instance(), false, -1);
  }
  const calx_motion* motion() const { return table_; }
  calx_pose raw(double t) const {
    calx_pose p;
    REQUIRE(table_->pose(instance(), t, &p) == CALX_OK);
    return p;
  }
  calx::Pose pose(double t) const { return set_.pose(index_, t); }
  double duration() const { return table_->duration(instance()); }
  double top_speed(double r) const { return table_->top_speed(instance(), r); }

 private:
  const calx_motion* table_;
  calx::MotionSet set_;
  int index_ = -1;
};

inline bool same_bits(const calx_pose& a, const calx_pose& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// kinks: times where the velocity may jump. until: how long to look, s. The tolerance is relative to the top speed:
/// h^2/6 of the relative third derivative, and rounding 1e-16 * length / h over the speed.
inline void check_motion(const LoadedMotion& m, const std::vector<double>& kinks, double until,
                         double tolerance = 1e-7) {
  const double h = 1e-6 * until, radius = 0.7;
  const double top = m.top_speed(radius);
  const calx::Vec3 arms[] = {{radius, 0, 0}, {0, radius, 0}, {0, 0, -radius}};
  const calx::Vec3 pivot = m.pose(-1).to_part(m.pose(-1).centre);
  double fastest = 0;
  for (int k = 0; k < 1000; ++k) {
    const double t = (k + 0.37) * until / 1000;
    bool near_kink = false;
    for (const double kink : kinks) near_kink = near_kink || std::fabs(t - kink) <= 2 * h;
    if (near_kink) continue;
    const calx::Pose now = m.pose(t), before = m.pose(t - h), after = m.pose(t + h);
    for (const calx::Vec3& arm : arms) {
      const calx::Vec3 p = pivot + arm, velocity = now.velocity_at(now.to_world(p));
      const calx::Vec3 difference = (after.to_world(p) - before.to_world(p)) / (2 * h);
      CAPTURE(t);
      REQUIRE(norm(velocity - difference) <= tolerance * top);
      fastest = std::max(fastest, norm(velocity));
    }
    // The quaternion keeps its sign along the motion.
    const calx::Quat a = before.turn, b = after.turn;
    REQUIRE(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z > 0.9);
    REQUIRE(same_bits(m.raw(t), m.raw(t)));
  }
  CHECK(fastest <= top * (1 + 1e-12));
  CHECK(fastest >= 0.9 * top);  // a bound that is no use would hide a wrong unit

  const calx_pose rest = m.raw(0), earlier = m.raw(-3);
  CHECK(same_bits(rest, earlier));
  for (int k = 0; k < 3; ++k) {
    CHECK(rest.velocity[k] == 0);
    CHECK(rest.spin[k] == 0);
  }
  if (std::isfinite(m.duration())) {
    const calx_pose end = m.raw(m.duration()), later = m.raw(2 * m.duration());
    CHECK(same_bits(end, later));
    for (int k = 0; k < 3; ++k) {
      CHECK(end.velocity[k] == 0);
      CHECK(end.spin[k] == 0);
    }
    // No jump at the end.
    const calx::Pose p = m.pose(m.duration() * (1 - 1e-9)), q = m.pose(m.duration());
    CHECK(norm(p.to_world(pivot + arms[0]) - q.to_world(pivot + arms[0])) <= 2e-9 * m.duration() * top);
  }
  calx_pose out;
  CHECK(m.motion()->pose(m.instance(), std::numeric_limits<double>::quiet_NaN(), &out) == CALX_E_ARGUMENT);
  CHECK(m.motion()->pose(m.instance(), std::numeric_limits<double>::infinity(), &out) == CALX_E_ARGUMENT);
  CHECK(m.message() == "a pose was asked for a time that is not finite");
}

}  // namespace calx_test
