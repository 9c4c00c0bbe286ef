// settings.hpp: a case as typed, validated settings. SI units, radians, world frame. Everything a case can say is here;
// what only a plugin understands stays JSON text in Parameters until the plugin's tables are known.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace calx {

/// A JSON object that a plugin's tables will read, and the JSON pointer where it stands, for messages.
struct Parameters {
  std::string json = "{}";
  std::string pointer;
  std::string folder;  // absolute; relative paths in the object start here; empty: the folder of the case file
};

struct MaterialSettings {
  std::string name, pointer;
  double density = 0;     // kg/m^3
  Parameters properties;  // the whole object; contact laws take what their material tables name (young, poisson, ...)
};

/// One law of a contact's list; wrenches of a list add in order.
struct LawSettings {
  std::string law;   // plugin id
  std::string name;  // unique in its list; the law's id when not given
  Parameters parameters;
  std::string pointer;
};

struct ContactSettings {
  std::string between[2];
  std::vector<LawSettings> laws;
  std::string pointer;
};

struct SphereSettings {
  Vec3 at;  // m, shape frame; need not be centred, the engine moves to the centre of mass and principal axes
  double radius = 0;
};

struct ShapeSettings {
  std::string name, pointer;
  std::vector<SphereSettings> spheres;
};

/// Scale factor applied to a shape, 1 = as drawn.
struct SizeSettings {
  enum class Kind { fixed, uniform, normal, lognormal, list } kind = Kind::fixed;
  double scale = 1;                    // fixed; mean of normal; median of lognormal
  double deviation = 0;                // normal: of the scale; lognormal: of ln(scale)
  double lowest = 1, highest = 1;      // uniform: the range; normal and lognormal: cut-offs
  std::vector<double> scales, shares;  // list: scales and their shares by mass, which sum to 1
};

/// A volume in the world frame. Box: lo, hi. Cylinder: axis from a to b, radius. Cone: axis from a to b, radius at a,
/// radius_b at b. Sphere: centre a, radius.
struct RegionSettings {
  enum class Kind { box, cylinder, cone, sphere } kind = Kind::box;
  std::string name, pointer;
  Vec3 a, b;
  double radius = 0, radius_b = 0;  // m
  std::string follows;              // name of a part whose motion carries the region; empty: fixed
  bool is_named = true;             // false: written inline by a sensor or condition, its name made up by the reader
  bool contains(const Vec3& p) const;
  double volume() const;  // m^3
  Box bounds() const;
};

/// When something happens. Leaf kinds look at the world; all and any combine; after shifts another event.
struct ConditionSettings {
  enum class Kind { time, mass, count, settled, cycle, after, all, any } kind = Kind::time;
  double time = 0;                       // time: at this time, s; after: this long after the event, s
  std::string region;                    // mass, count, settled: in this region; empty: the whole domain
  double value = 0;                      // mass: kg; count; cycle: number of completed cycles
  bool at_least = true;                  // mass, count: fires when >= value (else <=)
  double kinetic_per_particle = 0;       // settled: J; 0: the default m g d / 1000 of each particle
  double hold = 0;                       // settled: for this long, s
  double not_before = 0;                 // settled: earliest time after arming, s
  std::string event;                     // after: which; {"event": "name"} is after with no delay
  std::string motion;                    // cycle: of this motion
  std::vector<ConditionSettings> parts;  // all, any
  std::string pointer;
};

struct EventSettings {
  std::string name;
  ConditionSettings when;
};

struct SourceSettings {
  std::string name, shape, material, pointer;
  SizeSettings size;
  RegionSettings region;
  double mass = 0;          // kg requested; 0 when count is given
  std::uint64_t count = 0;  // particles requested; 0 when mass is given
  double rate = 0;          // kg/s; 0: at once (fill the region)
  Vec3 velocity;            // m/s, of new particles
  std::string when;         // event name; empty: at t = 0
  bool random_orientation = true;
  /// Positions given outright instead of a random fill: x y z (m) per particle, optionally with quaternions w x y z.
  std::vector<Vec3> positions;
  std::vector<Quat> orientations;
  std::vector<Vec3> velocities, spins;
  std::string file;  // absolute path of a CSV with header x_m,y_m,z_m[,vx_m_s,vy_m_s,vz_m_s][,scale]; empty: none
};

struct PartSettings {
  std::string name, geometry, material, motion, pointer;
  Parameters parameters;
  bool present = true;            // in the world from the start; stages and events may add or remove it
  std::string appears, vanishes;  // event names; empty: never changes
  bool assumed = false;
};

struct MotionSettings {
  std::string name, plugin, pointer;
  Parameters parameters;
  std::string start;       // event name; empty: t = 0
  std::string carried_by;  // another motion applied on top (the part's frame moves with it); empty: none
};

struct ForceSettings {
  std::string plugin, pointer;
  Parameters parameters;
};

/// A sensor plugin that reads another sensor's figure instead of the particles, as a slow load cell does.
struct InstrumentSettings {
  std::string plugin, column, pointer;  // column of the sensor it changes; empty: the first
  Parameters parameters;
};

struct SensorSettings {
  std::string name, kind, pointer;  // kind: built-in name or a plugin id
  double every = 0;                 // s of simulated time between samples
  Parameters parameters;  // the whole object but for instruments, inline regions replaced by their made-up names
  std::vector<InstrumentSettings> instruments;  // in the order in which the figures pass them
};

struct StageSettings {
  std::string name, until, pointer;             // until: event name; empty: to the end of the run
  std::vector<std::string> add, remove, start;  // part names, part names, motion names
};

struct TimeSettings {
  enum class Integrator { euler, verlet } integrator = Integrator::euler;
  double rayleigh_fraction = 0.1;
  double step = 0;        // s; 0: from the limits
  double end = 0;         // s
  std::string end_event;  // stop when it fires; empty: at end
};

struct DomainSettings {
  Box box;
  std::array<bool, 3> periodic{false, false, false};
  enum class OnLeave { error, remove, count } on_leave = OnLeave::error;
};

struct OutputSettings {
  double frames_every = 0;            // s simulated; 0: none
  double checkpoint_every_wall = 60;  // s of wall time; 0: only at the end and on interruption
  double checkpoint_every = 0;        // s simulated; 0: off
  bool particles_h5 = true;
};

struct NeighbourSettings {
  double skin = 0;  // m; 0: 0.1 of the smallest radius... chosen by the engine
};

/// Particles that no longer move are left out of the steps, where a case asks for it.
struct RestSettings {
  bool on = false;
  double after = 0.02;         // s, quiet for so long
  double displacement = 1e-3;  // of the radius: moved by no more within "after"
  double force = 0.1;          // of the weight: out of balance by no more
};

/// Grains made larger by one factor while vessels stay; rules in config/scale.hpp.
struct ScaleSettings {
  double factor = 1;
  enum class Cohesion { strength, bond } cohesion = Cohesion::strength;
};

/// Record of an effect that was put into the case (config/effects.hpp).
struct EffectSettings {
  std::string effect, version;
  std::string on = "{}", parameters = "{}";  // JSON objects
};

struct CaseSettings {
  std::string file;    // path of the case, for messages
  std::string folder;  // absolute; relative paths of the case start here
  std::string title;
  Vec3 gravity{0, 0, -9.81};
  DomainSettings domain;
  TimeSettings time;
  std::uint64_t seed = 1;
  std::vector<MaterialSettings> materials;
  std::vector<ContactSettings> contacts;
  std::vector<ShapeSettings> shapes;
  std::vector<RegionSettings> regions;
  std::vector<SourceSettings> sources;
  std::vector<PartSettings> parts;
  std::vector<MotionSettings> motions;
  std::vector<EventSettings> events;  // named ones, then those written inline ("source hopper fill")
  std::vector<StageSettings> stages;
  std::vector<ForceSettings> forces;
  std::vector<SensorSettings> sensors;
  OutputSettings output;
  NeighbourSettings neighbour;
  RestSettings rest;
  ScaleSettings scale;         // shapes, counts, the given step, the skin and energies of conditions have it already
  bool energy_ledger = false;  // "energy": true, or a sensor of kind "energy"
  double overlap_limit = 0.5;  // of the radius: beyond it the run stops as a blow-up or a particle gone through a wall
  std::vector<std::string> assumptions;
  std::vector<EffectSettings> effects;
  std::vector<std::pair<std::string, std::string>> plugin_pins;  // id, sha256
};

}  // namespace calx
