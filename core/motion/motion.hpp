// motion.hpp: where parts are at a time, and when things happen: poses, events and stages.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/state.hpp"
#include "base/vec3.hpp"
#include "calx/servo.h"
#include "calx/state.h"
#include "config/settings.hpp"

namespace calx {

/// Pose and velocity of a rigid part: a point X of the part frame is at shift + rotate(turn, X); its velocity is
/// velocity + spin x (x - centre).
struct Pose {
  Quat turn;
  Vec3 shift;     // m
  Vec3 centre;    // m, where the pivot is now
  Vec3 velocity;  // m/s, of the pivot
  Vec3 spin;      // rad/s
  double angle = 0, cycle = 0;
  Vec3 to_world(const Vec3& p) const { return shift + rotate(turn, p); }
  Vec3 to_part(const Vec3& p) const { return rotate(conjugate(turn), p - shift); }
  Vec3 velocity_at(const Vec3& world) const { return velocity + cross(spin, world - centre); }
};

/// What particles do to a part: force N and torque N m about its centre (m), world frame, of the last contacts.
struct MovedLoad {
  int motion = -1;  // of the part
  Vec3 centre, force, torque;
};

/// Every motion of a case: pure functions of time and servos, which react to loads. A motion without start event runs
/// from t = 0, others rest until started. [main]
class MotionSet {
 public:
  /// table and instance outlive the set. Returns the motion's index. carried_by: index of the motion applied on top of
  /// this one, or -1; it may be added later. Throws Error(Fault::settings) for motions that carry each other in a
  /// circle.
  int add(const std::string& name, const calx_motion* table, const calx_instance* instance, bool waits_for_start,
          int carried_by);
  /// The same for a servo; its state is kept in the instance, and saved through the other table.
  int add_servo(const std::string& name, const calx_servo* servo, const calx_state* state, calx_instance* instance,
                const calx_host* host, bool waits_for_start, int carried_by);
  bool has_servo() const;
  /// Takes every started servo from its pose one step before to that at time t, s; dt later than the pose before. A
  /// servo feels its own parts and those of motions it carries. Returns the number of the servo that failed and its
  /// status, or {-1, CALX_OK}.
  std::pair<int, calx_status> advance(double t, double dt, const std::vector<MovedLoad>& loads);
  int find(const std::string& name) const;  // -1: none
  std::size_t count() const { return motions_.size(); }
  /// Starts a waiting motion at time t, s; a second start is ignored.
  void start(int motion, double t);
  bool started(int motion) const { return motions_[static_cast<std::size_t>(motion)].started; }
  double start_time(int motion) const { return motions_[static_cast<std::size_t>(motion)].start; }
  /// World pose at time t, for a servo its present one; motion -1 stands still at the origin. angle and cycle are the
  /// motion's own, without what carries it. Throws Error(Fault::plugin) when the plugin fails or returns a pose that is
  /// no rigid motion.
  Pose pose(int motion, double t) const;
  /// True while the pose can still change after t; false while the motion waits for its start.
  bool moving(int motion, double t) const;
  /// Bound of the speed, m/s, of points within radius, m, of the pivot, carrying motions included. Where a turning
  /// motion carries one that shifts its pivot, the way of the pivot is sampled.
  double top_speed(int motion, double radius) const;
  void save(StateWriter& out) const;
  /// Throws Error(Fault::files) when the checkpoint was written with other motions.
  void load(const StateReader& in);

 private:
  struct Entry {
    std::string name;
    const calx_motion* table = nullptr;  // null: a servo
    const calx_servo* servo = nullptr;
    const calx_state* state = nullptr;
    const calx_host* host = nullptr;
    calx_instance* servo_instance = nullptr;
    const calx_instance* instance = nullptr;
    bool started = false;
    double start = 0;
    int carried_by = -1;
  };
  int add(Entry e, const std::string& name, bool waits_for_start, int carried_by);
  const Entry& entry(int motion) const;
  bool carries(int carrier, int motion) const;
  Pose own_pose(const Entry& e, double t) const;
  double own_top_speed(const Entry& e, double radius) const;
  double pivot_reach(int motion, int carrier) const;
  std::vector<Entry> motions_;
};

/// What events may ask of the world. Implemented by sim/.
class EventView {
 public:
  virtual ~EventView() = default;
  virtual double mass_in(const std::string& region) const = 0;  // kg; "" = everything
  virtual std::uint64_t count_in(const std::string& region) const = 0;
  /// Largest allowed mean kinetic energy is per_particle J, or m g d / 1000 when 0. False when the region is empty.
  virtual bool settled_in(const std::string& region, double per_particle) const = 0;
  virtual double cycles_of(const std::string& motion) const = 0;  // completed cycles, 0 before its start
};

/// Fires each event once, in the order of the case; an event may follow another within the same step. Conditions that
/// look at particles (mass, count, settled) are asked only every check interval, s, so that they cost nothing in the
/// step loop; between two checks they are unknown, and an event that needs one waits. The parts of "all" are read in
/// order and a later part is armed only while the earlier ones hold: in all [after "poured", settled], hold and
/// not_before count from "poured". A condition on its own is armed by the first update.
class EventSet {
 public:
  EventSet() = default;
  EventSet(const std::vector<EventSettings>& events, double check_interval);
  /// Names of events that fire at time t. [main]
  std::vector<std::string> update(double t, const EventView& view);
  /// Whether an update at time t, s, after one at `before` without any in between, would look at nothing but the clock
  /// and find every answer as it was. cycles: of a motion at a time, as EventView::cycles_of.
  bool still(double before, double t, const std::function<double(const std::string&, double)>& cycles) const;
  /// Fires an event that has no condition of its own (stages announce themselves so).
  void fire(const std::string& name, double t);
  bool fired(const std::string& name) const;
  double time_of(const std::string& name) const;  // s; negative: not yet
  void save(StateWriter& out) const;
  /// Throws Error(Fault::files) when the checkpoint was written with other events.
  void load(const StateReader& in);

 private:
  struct Settling {     // memory of one settled leaf
    double armed = -1;  // s, when its event first waited for nothing but it; -1: not yet
    double since = -1;  // s, since when the region has been settled at each check; -1: it is not
  };
  struct Entry {
    EventSettings settings;
    double fired_at = -1;
    std::vector<Settling> leaves;  // settled leaves in reading order
  };
  enum class Answer { no, unknown, yes };
  struct Question;
  Answer answer(const ConditionSettings& c, std::size_t leaf, Question& q) const;
  Answer answer_all(const ConditionSettings& c, std::size_t leaf, Question& q) const;
  Answer answer_any(const ConditionSettings& c, std::size_t leaf, Question& q) const;
  Answer answer_settled(const ConditionSettings& c, Settling& leaf, const Question& q) const;
  bool still(const ConditionSettings& c, double before, double t,
             const std::function<double(const std::string&, double)>& cycles) const;
  std::vector<Entry> events_;
  std::vector<std::pair<std::string, double>> announced_;
  double check_interval_ = 0, next_check_ = 0;
};

}  // namespace calx
