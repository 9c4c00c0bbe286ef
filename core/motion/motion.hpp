// motion.hpp: where parts are at a time, and when things happen: poses, events and stages.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/state.hpp"
#include "base/vec3.hpp"
#include "calx/motion.h"
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

/// Every motion of a case; a motion without start event runs from t = 0, others rest until started. [main]
class MotionSet {
 public:
  /// table and instance outlive the set. Returns the motion's index. carried_by: index of the motion applied on top of
  /// this one, or -1.
  int add(const std::string& name, const calx_motion* table, const calx_instance* instance, bool waits_for_start,
          int carried_by);
  int find(const std::string& name) const;  // -1: none
  std::size_t count() const { return motions_.size(); }
  /// Starts a waiting motion at time t, s; a second start is ignored.
  void start(int motion, double t);
  bool started(int motion) const { return motions_[static_cast<std::size_t>(motion)].started; }
  double start_time(int motion) const { return motions_[static_cast<std::size_t>(motion)].start; }
  /// World pose at time t; -1 gives the pose at rest. Throws Error(Fault::plugin) when the plugin fails.
  Pose pose(int motion, double t) const;
  /// True while the pose can still change after t.
  bool moving(int motion, double t) const;
  double top_speed(int motion, double radius) const;
  void save(StateWriter& out) const;
  void load(const StateReader& in);

 private:
  struct Entry {
    std::string name;
    const calx_motion* table = nullptr;
    const calx_instance* instance = nullptr;
    bool started = false;
    double start = 0;
    int carried_by = -1;
  };
  std::vector<Entry> motions_;
};

/// What events may ask of the world. Implemented by sim/.
class EventView {
 public:
  virtual ~EventView() = default;
  virtual double mass_in(const std::string& region) const = 0;               // kg; "" = everything
  virtual std::uint64_t count_in(const std::string& region) const = 0;
  /// Largest allowed mean kinetic energy is per_particle J, or m g d / 1000 when 0. False when the region is empty.
  virtual bool settled_in(const std::string& region, double per_particle) const = 0;
  virtual double cycles_of(const std::string& motion) const = 0;             // completed cycles, 0 before its start
};

/// Fires each event once, in the order of the case; an event may follow another within the same step. Conditions that
/// look at particles are asked at most once per check interval, s, so that they cost nothing in the step loop.
class EventSet {
 public:
  EventSet() = default;
  EventSet(const std::vector<EventSettings>& events, double check_interval);
  /// Names of events that fire at time t. [main]
  std::vector<std::string> update(double t, const EventView& view);
  /// Fires an event that has no condition of its own (stages announce themselves so).
  void fire(const std::string& name, double t);
  bool fired(const std::string& name) const;
  double time_of(const std::string& name) const;  // s; negative: not yet
  void save(StateWriter& out) const;
  void load(const StateReader& in);

 private:
  struct Entry {
    EventSettings settings;
    double fired_at = -1;
    std::vector<double> since;  // per settled leaf, in reading order: time since which it has held, or -1
  };
  bool holds(const ConditionSettings& c, Entry& entry, std::size_t& leaf, double t, const EventView& view);
  std::vector<Entry> events_;
  std::vector<std::pair<std::string, double>> announced_;
  double check_interval_ = 0, next_check_ = 0;
};

}  // namespace calx
