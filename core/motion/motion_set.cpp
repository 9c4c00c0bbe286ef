// motion_set.cpp: poses of parts from the motions of plugins, and motions carried by others.
// Called once per part and step, with a handful of parts; the cost is the plugin's sine and cosine.
#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "base/error.hpp"
#include "base/plugin_state.hpp"
#include "motion/motion.hpp"
#include "motion/saved_names.hpp"

namespace calx {
namespace {

Vec3 vector(const double* p) { return {p[0], p[1], p[2]}; }

bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// A number for a message; to_string would show a small one as 0.
std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

}  // namespace

int MotionSet::add(const std::string& name, const calx_motion* table, const calx_instance* instance,
                   bool waits_for_start, int carried_by) {
  Entry e;
  e.table = table;
  e.instance = instance;
  return add(std::move(e), name, waits_for_start, carried_by);
}

int MotionSet::add_servo(const std::string& name, const calx_servo* servo, const calx_state* state,
                         calx_instance* instance, const calx_host* host, bool waits_for_start, int carried_by) {
  Entry e;
  e.servo = servo;
  e.state = state;
  e.host = host;
  e.servo_instance = instance;
  e.instance = instance;
  return add(std::move(e), name, waits_for_start, carried_by);
}

int MotionSet::add(Entry e, const std::string& name, bool waits_for_start, int carried_by) {
  e.name = name;
  e.started = !waits_for_start;
  e.carried_by = carried_by;
  motions_.push_back(std::move(e));
  const int added = static_cast<int>(motions_.size()) - 1;
  std::string chain = "\"" + name + "\"";
  for (int k = carried_by; k >= 0 && k <= added; k = motions_[static_cast<std::size_t>(k)].carried_by) {
    chain += " by \"" + motions_[static_cast<std::size_t>(k)].name + "\"";
    if (k == added)
      throw Error(Fault::settings, "motion \"" + name + "\": motions carry each other in a circle: " + chain +
                                       "; one of them must be carried by nothing");
  }
  return added;
}

int MotionSet::find(const std::string& name) const {
  for (std::size_t k = 0; k < motions_.size(); ++k)
    if (motions_[k].name == name) return static_cast<int>(k);
  return -1;
}

const MotionSet::Entry& MotionSet::entry(int motion) const {
  if (motion < 0 || static_cast<std::size_t>(motion) >= motions_.size())
    throw Error(Fault::settings, "motion number " + std::to_string(motion) + " does not exist; the case has " +
                                     std::to_string(motions_.size()));
  return motions_[static_cast<std::size_t>(motion)];
}

void MotionSet::start(int motion, double t) {
  entry(motion);
  Entry& e = motions_[static_cast<std::size_t>(motion)];
  if (e.started) return;
  e.started = true;
  e.start = t;
}

Pose MotionSet::own_pose(const Entry& e, double t) const {
  calx_pose raw{};
  const double since_start = e.started ? t - e.start : 0;
  const calx_status status = e.servo ? e.servo->pose(e.instance, &raw) : e.table->pose(e.instance, since_start, &raw);
  if (status != CALX_OK)
    throw Error(Fault::plugin, "motion \"" + e.name + "\" at t = " + number(t) +
                                   " s: the plugin gives no pose and returns status " + std::to_string(status));
  Pose p;
  p.turn = {raw.quaternion[0], raw.quaternion[1], raw.quaternion[2], raw.quaternion[3]};
  const double length2 = p.turn.w * p.turn.w + p.turn.x * p.turn.x + p.turn.y * p.turn.y + p.turn.z * p.turn.z;
  const Vec3 pivot = vector(raw.pivot), displacement = vector(raw.displacement);
  p.velocity = vector(raw.velocity);
  p.spin = vector(raw.spin);
  // A quaternion built from a sine and a cosine has unit length within some 1e-16; a length off by more scales the
  // part.
  if (!(std::fabs(length2 - 1) < 1e-9) || !is_finite(pivot) || !is_finite(displacement) || !is_finite(p.velocity) ||
      !is_finite(p.spin))
    throw Error(Fault::plugin, "motion \"" + e.name + "\" at t = " + number(t) +
                                   " s: the plugin's pose is no rigid motion (squared length of the quaternion " +
                                   number(length2) + "); it must be 1 and all numbers finite");
  // pivot - rotate(pivot) first: it is exactly 0 without rotation, so a pure displacement stays free of rounding.
  p.shift = displacement + (pivot - rotate(p.turn, pivot));
  p.centre = pivot + displacement;
  p.angle = raw.angle;
  p.cycle = raw.cycle;
  return p;
}

Pose MotionSet::pose(int motion, double t) const {
  if (motion < 0) return {};
  Pose p = own_pose(entry(motion), t);
  for (int k = entry(motion).carried_by; k >= 0; k = entry(k).carried_by) {
    const Pose outer = own_pose(entry(k), t);
    p.shift = outer.to_world(p.shift);
    p.centre = outer.to_world(p.centre);
    p.turn = outer.turn * p.turn;
    p.velocity = outer.velocity_at(p.centre) + rotate(outer.turn, p.velocity);
    p.spin = outer.spin + rotate(outer.turn, p.spin);
  }
  return p;
}

bool MotionSet::has_servo() const {
  return std::any_of(motions_.begin(), motions_.end(), [](const Entry& e) { return e.servo; });
}

bool MotionSet::carries(int carrier, int motion) const {
  for (int k = motion; k >= 0; k = entry(k).carried_by)
    if (k == carrier) return true;
  return false;
}

std::pair<int, calx_status> MotionSet::advance(double t, double dt, const std::vector<MovedLoad>& loads) {
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const Entry& e = motions_[k];
    const int number = static_cast<int>(k);
    if (!e.servo || !e.started || !(t > e.start)) continue;
    const Vec3 centre = pose(number, t - dt).centre;
    Quat turn;
    for (int c = e.carried_by; c >= 0; c = entry(c).carried_by) turn = own_pose(entry(c), t - dt).turn * turn;
    Vec3 force, torque;
    for (const MovedLoad& load : loads) {
      if (!carries(number, load.motion)) continue;
      force += load.force;
      torque += load.torque + cross(load.centre - centre, load.force);
    }
    const Vec3 f = rotate(conjugate(turn), force), m = rotate(conjugate(turn), torque);
    const calx_servo_view view = {sizeof(calx_servo_view), 0, t - e.start, dt, {f.x, f.y, f.z}, {m.x, m.y, m.z}};
    const calx_status status = e.servo->advance(e.servo_instance, e.host, &view);
    if (status < 0) return {number, status};
  }
  return {-1, CALX_OK};
}

bool MotionSet::moving(int motion, double t) const {
  for (int k = motion; k >= 0; k = entry(k).carried_by) {
    const Entry& e = entry(k);
    if (e.started && (e.servo || t - e.start < e.table->duration(e.instance))) return true;
  }
  return false;
}

double MotionSet::own_top_speed(const Entry& e, double radius) const {
  const double speed = e.servo ? e.servo->top_speed(e.instance, radius) : e.table->top_speed(e.instance, radius);
  if (!(speed >= 0) || !std::isfinite(speed))
    throw Error(Fault::plugin, "motion \"" + e.name + "\": the plugin's top speed within " + number(radius) + " m is " +
                                   number(speed) + " m/s; it must be finite and not negative");
  return speed;
}

// Largest distance of a motion's pivot from the pivot of its carrier, before the carrier moves both.
double MotionSet::pivot_reach(int motion, int carrier) const {
  Entry inner = entry(motion), outer = entry(carrier);
  inner.started = true;
  inner.start = 0;
  outer.started = false;
  const Pose rest = own_pose(outer, 0);
  const Vec3 origin = rest.to_part(rest.centre);
  if (inner.servo) {
    const double reach = inner.servo->reach(inner.instance);
    if (!(reach >= 0) || !std::isfinite(reach))
      throw Error(Fault::plugin, "motion \"" + inner.name + "\": the plugin's reach is " + number(reach) +
                                     " m; it must be finite and not negative");
    return norm(own_pose(inner, 0).centre - origin) + reach;
  }
  if (own_top_speed(inner, 0) == 0) return norm(own_pose(inner, 0).centre - origin);
  // Steps of the golden ratio visit every phase of a vibration, whatever its period.
  const double horizon = std::min(inner.table->duration(inner.instance), 1000.0);
  double reach = norm(own_pose(inner, horizon).centre - origin);
  for (int k = 0; k < 1024; ++k) {
    const double share = k * 0.6180339887498949;
    const double t = horizon * (share - std::floor(share));
    reach = std::max(reach, norm(own_pose(inner, t).centre - origin));
  }
  return reach;
}

double MotionSet::top_speed(int motion, double radius) const {
  if (motion < 0) return 0;
  double speed = own_top_speed(entry(motion), radius), reach = radius;
  for (int inner = motion, k = entry(motion).carried_by; k >= 0; inner = k, k = entry(k).carried_by) {
    reach += pivot_reach(inner, k);
    speed += own_top_speed(entry(k), reach);
  }
  return speed;
}

void MotionSet::save(StateWriter& out) const {
  std::string names;
  std::vector<std::uint8_t> started;
  std::vector<double> start;
  for (const Entry& e : motions_) {
    append_name(names, e.name);
    started.push_back(e.started ? 1 : 0);
    start.push_back(e.start);
  }
  out.put_text("motions/names", names);
  out.put("motions/started", started.data(), started.size());
  out.put("motions/start", start.data(), start.size(), "s");
  for (std::size_t k = 0; k < motions_.size(); ++k)
    if (motions_[k].servo)
      save_plugin_state(*motions_[k].state, motions_[k].instance, out, "motions/state/" + std::to_string(k),
                        "motion \"" + motions_[k].name + "\"");
}

void MotionSet::load(const StateReader& in) {
  std::string names;
  for (const Entry& e : motions_) append_name(names, e.name);
  const std::string saved = in.get_text("motions/names");
  const auto started = in.get_u8("motions/started");
  const auto start = in.get_doubles("motions/start");
  if (saved != names || started.size() != motions_.size() || start.size() != motions_.size())
    throw Error(Fault::files, "motions/names: the checkpoint holds the motions [" + listed(saved) +
                                  "], the case has [" + listed(names) +
                                  "]; resume with the case the checkpoint was written with");
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    motions_[k].started = started[k] != 0;
    motions_[k].start = start[k];
    if (motions_[k].servo)
      load_plugin_state(*motions_[k].state, motions_[k].servo_instance, in, "motions/state/" + std::to_string(k),
                        "motion \"" + motions_[k].name + "\"");
  }
}

}  // namespace calx
