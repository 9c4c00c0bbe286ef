// motion_checks.cpp: pose and velocity of a motion over its time.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "base/vec3.hpp"
#include "conformance/checks.hpp"

namespace calx::conformance {
namespace {

struct Moved {
  InstancePtr instance;
  const calx_motion* table;
  std::string name;
  double span;  // s, the time to look at

  calx_pose at(double t) const {
    calx_pose pose;
    std::memset(&pose, 0, sizeof pose);
    const calx_status status = table->pose(instance->get(), t, &pose);
    require(status >= 0, name + ": no pose at t = " + short_number(t) + " s");
    return pose;
  }
};

/// Of the first cycle, by bisection of the cycle count.
double cycle_time(const Moved& m) {
  double low = 0, high = m.span;
  for (int k = 0; k < 200; ++k) (m.at(0.5 * (low + high)).cycle < 1 ? low : high) = 0.5 * (low + high);
  return high;
}

std::vector<Moved> motions(Subject& s) {
  std::vector<Moved> out;
  for (const Variant& variant : s.variants()) {
    Moved m{nullptr, nullptr, variant.name, 0};
    try {
      m.instance = s.make(variant);
    } catch (const Failed&) {
      continue;  // creates tells it
    }
    m.table = static_cast<const calx_motion*>(m.instance->table(CALX_MOTION));
    require(m.table && m.table->pose && m.table->duration && m.table->top_speed, "it has no whole table " CALX_MOTION);
    const double duration = m.table->duration(m.instance->get());
    require(duration >= 0, m.name + ": its duration is " + short_number(duration) + " s");
    m.span = std::isfinite(duration) && duration > 0 ? 1.2 * duration : 10;
    out.push_back(m);
  }
  if (out.empty()) s.any();
  return out;
}

Vec3 vec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
Quat quat(const calx_pose& p) { return {p.quaternion[0], p.quaternion[1], p.quaternion[2], p.quaternion[3]}; }

Vec3 moved_point(const calx_pose& p, const Vec3& x) {
  return vec(p.pivot) + vec(p.displacement) + rotate(quat(p), x - vec(p.pivot));
}
/// Velocity of that point from velocity and spin of the pose.
Vec3 point_velocity(const calx_pose& p, const Vec3& x) {
  return vec(p.velocity) + cross(vec(p.spin), moved_point(p, x) - vec(p.pivot) - vec(p.displacement));
}

/// How a point moves around time t by differences over h, and what the pose says of it.
struct Differences {
  Vec3 told, left, right, middle;
  double speed, rounding;
  Differences(const Moved& m, const Vec3& x, double t, double h) {
    const Vec3 a2 = moved_point(m.at(t - 2 * h), x), a = moved_point(m.at(t - h), x), b = moved_point(m.at(t + h), x),
               b2 = moved_point(m.at(t + 2 * h), x);
    told = point_velocity(m.at(t), x);
    left = (a - a2) / h;
    right = (b2 - b) / h;
    middle = (b - a) / (2 * h);
    // Of positions, which are rounded to 1e-16 of themselves.
    rounding = 1e-15 * (norm(a) + 1e-3) / h;
    speed = std::max({norm(left), norm(right), norm(told), 1e3 * rounding});
  }
  bool is_smooth() const { return norm(left - right) <= 1e-3 * speed; }
};

std::string derivative(Subject& s) {
  double worst = 0;
  int kinks = 0, looked = 0;
  for (const Moved& m : motions(s)) {
    const Vec3 pivot = vec(m.at(0).pivot);
    const double r = 0.1;
    for (int k = 0; k < 400; ++k) {
      const double t = s.uniform(1e-5, 1 - 1e-5) * m.span;
      for (const Vec3& x : {pivot, pivot + Vec3{r, 0, 0}, pivot + Vec3{0, r, 0}, pivot + Vec3{0, 0, r}}) {
        // As wide as the motion allows: a fast vibration bends within a step that is fine for a slow turn.
        double h = 1e-6 * m.span;
        Differences d(m, x, t, h);
        for (int finer = 0; finer < 3 && !d.is_smooth(); ++finer) d = Differences(m, x, t, h *= 0.1);
        ++looked;
        // Where the speed jumps there is no derivative.
        if (!d.is_smooth()) {
          ++kinks;
          continue;
        }
        const double error = norm(d.told - d.middle);
        worst = std::max(worst, error / d.speed);
        // Curvature over h, at most as much as told smooth from jumping, enters the central difference squared.
        require(
            error <= 1e-4 * d.speed + 4 * d.rounding,
            m.name + ": at t = " + short_number(t) + " s a point moves with " + short_number(norm(d.middle)) +
                " m/s, but velocity and spin of the pose say " + short_number(norm(d.told)) + " m/s, " +
                short_number(error) + " m/s apart" +
                (norm(d.told + d.middle) <= 1e-2 * d.speed ? ", in the opposite direction: has velocity or spin the "
                                                             "wrong sign?"
                                                           : ""));
      }
    }
  }
  require(kinks * 5 <= looked, "its speed jumps at " + std::to_string(kinks) + " of " + std::to_string(looked) +
                                   " places looked at; a motion is smooth but for a few instants");
  return "largest relative difference " + short_number(worst);
}

std::string pure(Subject& s) {
  for (const Moved& m : motions(s)) {
    std::vector<double> times = {-1, 0, m.span};
    for (int k = 0; k < 200; ++k) times.push_back(s.uniform(0, m.span));
    std::vector<calx_pose> first;
    for (const double t : times) first.push_back(m.at(t));
    for (std::size_t k = times.size(); k-- > 0;) {
      const calx_pose again = m.at(times[k]);
      require(std::memcmp(&again, &first[k], sizeof again) == 0,
              m.name + ": the pose at t = " + short_number(times[k]) + " s has other bits when it is asked for again");
    }
    std::vector<int> good(16, 0);
    std::vector<std::thread> crew;
    for (std::size_t n = 0; n < good.size(); ++n)
      crew.emplace_back([&, n] {
        good[n] = 1;
        for (std::size_t k = 0; k < times.size(); ++k) {
          calx_pose pose;
          std::memset(&pose, 0, sizeof pose);
          m.table->pose(m.instance->get(), times[k], &pose);
          good[n] = good[n] && std::memcmp(&pose, &first[k], sizeof pose) == 0;
        }
      });
    for (std::thread& thread : crew) thread.join();
    for (const int one : good) require(one, m.name + ": 16 threads at once get other poses than one");
  }
  return "";
}

std::string quaternion(Subject& s) {
  for (const Moved& m : motions(s)) {
    calx_pose before = m.at(0);
    for (int k = 0; k <= 5000; ++k) {
      const double t = m.span * k / 5000;
      const calx_pose p = m.at(t);
      const double* q = p.quaternion;
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      require(std::fabs(length - 1) < 1e-12,
              m.name + ": the quaternion at t = " + short_number(t) + " s has the length " + short_number(length));
      double dot = 0;
      for (int c = 0; c < 4; ++c) dot += q[c] * before.quaternion[c];
      // Half of the turn between two looks; a fast motion may turn far, a change of sign alone gives -1.
      const double turn = std::fabs(p.angle - before.angle);
      require(dot > -0.99 || turn > 5, m.name + ": the quaternion changes sign at t = " + short_number(t) + " s");
      const Vec3 axis{q[1], q[2], q[3]};
      require(std::fabs(std::fabs(q[0]) - std::fabs(std::cos(0.5 * p.angle))) < 1e-9 || norm(axis) < 1e-12,
              m.name + ": at t = " + short_number(t) + " s the quaternion does not turn by the angle of the pose, " +
                  short_number(p.angle) + " rad");
      before = p;
    }
  }
  return "";
}

std::string ends(Subject& s) {
  for (const Moved& m : motions(s)) {
    const calx_pose rest = m.at(0);
    for (const double t : {-1e-9, -1.0, -1e9}) {
      const calx_pose p = m.at(t);
      require(std::memcmp(&p, &rest, sizeof p) == 0, m.name + ": before it starts the pose is not that of t = 0");
    }
    for (int c = 0; c < 3; ++c)
      require(rest.velocity[c] == 0 && rest.spin[c] == 0, m.name + ": at t = 0, still at rest, its velocity is not 0");
    const double duration = m.table->duration(m.instance->get());
    if (std::isfinite(duration)) {
      const calx_pose last = m.at(duration * (1 + 1e-12) + 1e-12);
      for (const double t : {duration + 1, 10 * duration + 1}) {
        const calx_pose p = m.at(t);
        for (int c = 0; c < 3; ++c) {
          require(p.velocity[c] == 0 && p.spin[c] == 0, m.name + ": it still moves after its duration");
          require(std::fabs(p.displacement[c] - last.displacement[c]) < 1e-12,
                  m.name + ": it is elsewhere after its duration");
        }
        require(std::fabs(p.angle - last.angle) < 1e-9, m.name + ": it turns on after its duration");
      }
    }
    for (const double t : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      calx_pose pose;
      require(m.table->pose(m.instance->get(), t, &pose) == CALX_E_ARGUMENT,
              m.name + ": a time that is not finite must give CALX_E_ARGUMENT");
    }
  }
  return "";
}

std::string top_speed(Subject& s) {
  for (const Moved& m : motions(s))
    for (const double r : {0.0, 0.1, 1.0}) {
      const double told = m.table->top_speed(m.instance->get(), r);
      require(std::isfinite(told) && told >= 0, m.name + ": its top speed is " + short_number(told) + " m/s");
      double seen = 0;
      for (int k = 0; k < 2000; ++k) {
        const calx_pose p = m.at(s.uniform(0, m.span));
        // The fastest point lies across the spin; along the velocity it could be both at once.
        seen = std::max(seen, std::max(norm(vec(p.velocity)), r * norm(vec(p.spin))));
      }
      require(seen <= told * (1 + 1e-9) + 1e-15, m.name + ": within " + short_number(r) + " m a point moves with " +
                                                     short_number(seen) + " m/s, but top_speed says " +
                                                     short_number(told) + " m/s; the time step relies on it");
    }
  return "";
}

std::string period(Subject& s) {
  bool any = false;
  for (const Moved& m : motions(s)) {
    if (m.at(m.span).cycle < 2) continue;
    const double high = cycle_time(m);
    any = true;
    for (int k = 0; k < 200; ++k) {
      const double t = s.uniform(0.01, 0.99) * high;
      const calx_pose a = m.at(t), b = m.at(t + high);
      if (b.cycle >= m.at(m.span).cycle) continue;
      require(
          std::fabs(b.cycle - a.cycle - 1) < 1e-6,
          m.name + ": the first cycle takes " + short_number(high) +
              " s from t = 0 on, but the next one does not take the same time; a rest before the first cycle belongs " +
              "into the event that starts the motion, not into the motion");
      // A table may go on from where it ended; its speeds repeat.
      const Vec3 v = vec(a.velocity), w = vec(b.velocity), x = vec(a.spin), y = vec(b.spin);
      const double scale = m.table->top_speed(m.instance->get(), 1.0);
      require(norm(v - w) + norm(x - y) < 1e-5 * scale + 1e-12,
              m.name + ": at t = " + short_number(t) + " s and one cycle, " + short_number(high) +
                  " s, later it moves at another speed; each cycle repeats the first, which begins at t = 0");
    }
  }
  if (!any) throw Skipped{"it has no cycles"};
  return "";
}

}  // namespace

std::vector<CheckCurve> motion_curves(Subject& s) {
  std::vector<CheckCurve> out;
  for (const Moved& m : motions(s)) {
    CheckCurve shift{"shift", m.name, {}, {}}, turn{"turn", m.name, {}, {}};
    const int looks = 1000;
    const double span = m.at(m.span).cycle > 3 ? 2.5 * cycle_time(m) : m.span;
    for (int k = 0; k <= looks; ++k) {
      const double t = span * k / looks;
      const calx_pose p = m.at(t);
      // Along one signed line where the motion has one, so that to and fro do not look alike.
      const Vec3 d = vec(p.displacement);
      double along = d.x;
      if (std::fabs(d.y) > std::fabs(along)) along = d.y;
      if (std::fabs(d.z) > std::fabs(along)) along = d.z;
      shift.x.push_back(t), shift.y.push_back(std::copysign(norm(d), along));
      turn.x.push_back(t), turn.y.push_back(p.angle * 180 / M_PI);
    }
    for (CheckCurve* curve : {&shift, &turn}) {
      const auto [low, high] = std::minmax_element(curve->y.begin(), curve->y.end());
      const bool seen = std::any_of(out.begin(), out.end(), [&](const CheckCurve& other) {
        return other.chart == curve->chart && other.y == curve->y && other.x == curve->x;
      });
      if (*low < *high && !seen && out.size() < 12) out.push_back(std::move(*curve));
    }
  }
  return out;
}

std::vector<Check> motion_checks() {
  constexpr const char* kind = CALX_MOTION;
  return {
      {"velocity", "Velocity and spin are the derivative of the pose.", kind, true, derivative},
      {"same-time", "The same time gives the same bits, in any order and on any thread.", kind, true, pure},
      {"quaternion", "The quaternion has unit length, keeps its sign and turns by the angle.", kind, false, quaternion},
      {"ends", "It rests before its start and after its duration; times that are not finite are refused.", kind, false,
       ends},
      {"top-speed", "No point moves faster than the stated top speed.", kind, true, top_speed},
      {"period", "Each cycle takes the same time and repeats the speeds of the first.", kind, true, period}};
}

}  // namespace calx::conformance
