// SPDX-License-Identifier: MIT
// calx/rigid_motion.hpp: optional C++11 helper for motion plugins; header only. The table of calx.motion/1 in C++, axis
// and angle to quaternion, and a trip out and back with a choice of speed profiles.
#ifndef CALX_RIGID_MOTION_HPP
#define CALX_RIGID_MOTION_HPP
#include <calx/plugin.hpp>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

namespace calx {
namespace rigid {

const double pi = 3.14159265358979323846;

struct Vector {
  double x, y, z;
  double length() const { return std::sqrt(x * x + y * y + z * z); }
};

/// A number for a message, with a point whatever the locale.
inline std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

/// The vector group "name" of a parameter table: name_x, name_y, name_z.
inline Vector vector(const calx_descriptor& d, const calx_config& c, const std::string& name) {
  return Vector{parameter(d, c, (name + "_x").c_str()), parameter(d, c, (name + "_y").c_str()),
                parameter(d, c, (name + "_z").c_str())};
}

/// The same, scaled to unit length; the user gives a direction of any length but 0.
inline Vector direction(const calx_descriptor& d, const calx_config& c, const std::string& name) {
  const Vector v = vector(d, c, name);
  const double n = v.length();
  if (!(n > 0)) throw ConfigError(name + ": [0, 0, 0] has no direction; give a vector of any length but 0");
  return Vector{v.x / n, v.y / n, v.z / n};
}

inline bool is_choice(const calx_descriptor& d, const calx_config& c, const char* name, int choice) {
  return std::fabs(parameter(d, c, name) - choice) < 0.5;
}

inline void set(double (&to)[3], const Vector& v, double scale) {
  to[0] = scale * v.x;
  to[1] = scale * v.y;
  to[2] = scale * v.z;
}

/// Turn by angle, rad, at rate, rad/s, about a unit axis through origin. Half of the unwrapped angle goes into sine and
/// cosine, so the quaternion is continuous beyond 180 degrees and changes sign after each full turn.
inline void turn(calx_pose& out, const Vector& origin, const Vector& axis, double angle, double rate) {
  const double s = std::sin(0.5 * angle);
  set(out.pivot, origin, 1);
  out.quaternion[0] = std::cos(0.5 * angle);
  out.quaternion[1] = s * axis.x;
  out.quaternion[2] = s * axis.y;
  out.quaternion[3] = s * axis.z;
  set(out.spin, axis, rate);
  out.angle = angle;
}

/// Base of a motion plugin: implements the C table; pose receives the pose of rest at the origin to fill in.
class Motion : public Instance {
 public:
  explicit Motion(const calx_host* host) : host_(host) {}
  virtual void pose(double t, calx_pose& out) const noexcept = 0;
  virtual double duration() const noexcept = 0;
  virtual double top_speed(double radius) const noexcept = 0;

  const void* get_interface(const char* id) const override {
    static const calx_motion table = {sizeof(calx_motion), CALX_ABI_DRAFT, &pose_of, &duration_of, &top_speed_of};
    return std::strcmp(id, CALX_MOTION) == 0 ? &table : 0;
  }

 private:
  static const Motion& self_of(const calx_instance* self) noexcept { return *static_cast<const Motion*>(self); }
  static calx_status CALX_CALL pose_of(const calx_instance* self, double t, calx_pose* out) noexcept {
    const calx_host* host = self_of(self).host_;
    if (!std::isfinite(t)) return host->fail(host, CALX_E_ARGUMENT, "a pose was asked for a time that is not finite");
    *out = calx_pose();
    out->quaternion[0] = 1;
    self_of(self).pose(t, *out);
    return CALX_OK;
  }
  static double CALX_CALL duration_of(const calx_instance* self) noexcept { return self_of(self).duration(); }
  static double CALX_CALL top_speed_of(const calx_instance* self, double r) noexcept {
    return self_of(self).top_speed(r);
  }
  const calx_host* host_;
};

/// A value and its derivative in time, 1/s.
struct Progress {
  double value, rate;
};

/// From 0 to 1 in `time`, rest for `hold`, and, if it returns, back to 0 in `time` again. At kinks the rate to the
/// right counts, as for the start of a later cycle; before the trip and after it there is rest.
struct Trip {
  enum Profile { constant, trapezoid, cosine };
  Profile profile;
  double share;  // of the time, spent speeding up and once more slowing down; trapezoid only
  double time, hold;
  bool returns;

  double end() const { return returns ? time + hold + time : time; }
  /// Largest over mean speed of one way.
  double peak() const { return profile == constant ? 1 : profile == cosine ? 0.5 * pi : 1 / (1 - share); }
  Progress at(double t) const {
    if (t < 0) return Progress{0, 0};
    if (t < time) return way(t);
    if (!returns || t < time + hold) return Progress{1, 0};
    if (!(t < end())) return Progress{0, 0};
    const Progress back = way(t - (time + hold));
    return Progress{1 - back.value, -back.rate};
  }

  /// The same as a motion asks for it: rest up to the start, the start included.
  Progress after_start(double t) const { return t > 0 ? at(t) : Progress{0, 0}; }

 private:
  Progress way(double t) const {
    const double u = t / time;
    if (profile == cosine) return Progress{0.5 * (1 - std::cos(pi * u)), 0.5 * pi * std::sin(pi * u) / time};
    if (profile == constant) return Progress{u, 1 / time};
    const double v = 1 / (1 - share);  // trapezoid of unit area
    if (u < share) return Progress{0.5 * v * u * u / share, v * u / (share * time)};
    if (u > 1 - share) return Progress{1 - 0.5 * v * (1 - u) * (1 - u) / share, v * (1 - u) / (share * time)};
    return Progress{v * (u - 0.5 * share), v / time};
  }
};

/// A trip with the profile of CALX_PROFILE_FIELDS.
inline Trip trip(const calx_descriptor& d, const calx_config& c, double time, double hold, bool returns) {
  const Trip::Profile profile = is_choice(d, c, "profile", Trip::constant)    ? Trip::constant
                                : is_choice(d, c, "profile", Trip::trapezoid) ? Trip::trapezoid
                                                                              : Trip::cosine;
  return Trip{profile, parameter(d, c, "acceleration_share"), time, hold, returns};
}

/// One trip with CALX_PROFILE_FIELDS and CALX_TRIP_FIELDS.
inline Trip single_trip(const calx_descriptor& d, const calx_config& c) {
  const double hold = parameter(d, c, "hold");
  const bool returns = is_choice(d, c, "then", 1);
  if (hold > 0 && !returns)
    throw ConfigError("hold: " + number(hold) +
                      " s has no effect while \"then\" is \"stay\"; remove it or write \"then\": \"return\"");
  return trip(d, c, parameter(d, c, "duration"), hold, returns);
}

}  // namespace rigid
}  // namespace calx

/* Rows of parameter tables: the vector groups are numbered by the plugin, unique in its table. */
// clang-format off
#define CALX_VECTOR_FIELDS(name, unit, limit, x, y, z, group, what)      \
  {name "_x", unit, what ", x", -(limit), limit, x, CALX_VEC(group), 0}, \
  {name "_y", unit, what ", y", -(limit), limit, y, CALX_VEC(group), 0}, \
  {name "_z", unit, what ", z", -(limit), limit, z, CALX_VEC(group), 0}
#define CALX_PROFILE_FIELDS                                                                               \
  {"profile", "constant|trapezoid|cosine",                                                                \
   "speed over one way: constant; trapezoid, with equal times of speeding up and slowing down; half a "   \
   "cosine", 0, 2, 0, CALX_FIELD_CHOICE, 0},                                                              \
  {"acceleration_share", "1", "share of the time of one way spent speeding up, and again slowing down; "  \
   "trapezoid only", 0.001, 0.5, 0.2, 0, 0}
#define CALX_TRIP_FIELDS                                                                                  \
  {"then", "stay|return", "stay at the end of the way, or return after the hold", 0, 1, 0,                \
   CALX_FIELD_CHOICE, 0},                                                                                 \
  {"hold", "s", "rest at the end of the way before the return", 0, 1e9, 0, 0, 0},                         \
  CALX_PROFILE_FIELDS
// clang-format on
#endif
