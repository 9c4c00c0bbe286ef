// world.hpp: what sensors and writers may read of a running simulation. Read only; valid between steps. [main]
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "config/settings.hpp"
#include "geometry/geometry.hpp"
#include "motion/motion.hpp"
#include "store/particles.hpp"

namespace calx {

/// Load of the particles on a part, world frame: force N, torque N m about the part's pivot.
struct PartLoad {
  Vec3 force, torque;
};

/// One touching contact. part >= 0: sphere i against that part, j unused.
struct ContactRow {
  std::uint32_t i = 0, j = 0;  // sphere numbers in present rank order
  int part = -1;
  double overlap = 0;  // m
  Vec3 normal;         // from j (or the wall) to i
};

/// Energies of the whole run, J. remainder = initial + inserted + wall_work - removed - (kinetic + gravity + elastic +
/// friction + damping + plastic): what time integration lost or gained.
struct EnergyLedger {
  bool kept = false;
  double kinetic_translation = 0, kinetic_rotation = 0, gravity = 0, elastic = 0;  // now
  double friction = 0, damping = 0, plastic = 0;                                   // lost so far
  double wall_work = 0;              // done by moving parts on particles so far
  double force_work = 0;             // done by particle-force plugins so far
  double inserted = 0, removed = 0;  // brought and taken by particles that came and went
  double remainder = 0;
  double work_done = 0;  // |gravity work| + |wall work| + inserted kinetic: the scale for remainder
};

/// Particle counts and masses of the whole run. Closes to the particle: inserted = inside + removed.
struct MassLedger {
  std::uint64_t inserted_count = 0, inside_count = 0, removed_count = 0;
  double inserted = 0, inside = 0, removed = 0;  // kg
  double requested = 0, delivered = 0;           // kg, of all sources
};

class WorldView {
 public:
  virtual ~WorldView() = default;
  virtual const CaseSettings& settings() const = 0;
  virtual double time() const = 0;
  virtual std::uint64_t step() const = 0;
  virtual double time_step() const = 0;
  virtual const Particles& particles() const = 0;
  virtual std::size_t part_count() const = 0;
  virtual const std::string& part_name(std::size_t part) const = 0;
  virtual bool part_present(std::size_t part) const = 0;
  virtual const Surface& part_surface(std::size_t part) const = 0;
  /// At time(); of a servo and of a part driven from outside, where it was moved to last.
  virtual Pose part_pose(std::size_t part) const = 0;
  /// Of the last step.
  virtual PartLoad part_load(std::size_t part) const = 0;
  virtual std::vector<ContactRow> contacts() const = 0;
  /// Touching contacts per sphere, walls included, in rank order.
  virtual std::vector<std::uint32_t> contact_counts() const = 0;
  virtual EnergyLedger energy() const = 0;
  virtual MassLedger mass() const = 0;
  virtual double cycles_of(const std::string& motion) const = 0;
  virtual double event_time(const std::string& event) const = 0;  // s; negative: not fired
  /// A named region at this moment (regions that follow a part move with it); null for an unknown name.
  virtual bool in_region(const std::string& region, const Vec3& p) const = 0;
};

}  // namespace calx
