// engine_detail.hpp: work spaces shared by the passes of a step. Private to step/.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "step/engine.hpp"
#include "step/kernels.hpp"

namespace calx {

/// Rows a block of contacts carries beside what a law sees.
struct Engine::Worker {
  explicit Worker(std::uint32_t state_columns)
      : in_double{BlockScratch(state_columns), {}, {}}, in_mixed{BlockScratchOf<float>(state_columns), {}, {}} {}
  /// Of the pair loop in one precision.
  template <class Real>
  struct PairWork {
    BlockScratchOf<Real> scratch;
    alignas(64) Real arm_i[kColumnStride<Real>], arm_j[kColumnStride<Real>];
  };
  PairWork<double> in_double;
  PairWork<float> in_mixed;
  PairScan scan;
  PairBlock found, picked;  // touching pairs, and those of them that one law list takes
  const LawList* list_of_row[kBlockRows];
  // Wall block.
  std::uint32_t wall_count = 0;
  const LawList* wall_law = nullptr;
  SurfacePoint found_points[kWallContacts];
  std::uint32_t wall_sphere[kBlockRows], wall_part[kBlockRows];
  std::size_t wall_slot[kBlockRows];
  Vec3 wall_arm[kBlockRows], wall_lever[kBlockRows], wall_velocity[kBlockRows], wall_spin[kBlockRows];
  // Columns for particle forces.
  std::vector<double> columns;
};

struct alignas(64) Engine::ChunkResult {
  double elastic = 0, friction = 0, damping = 0, plastic = 0, wall_work = 0, force_work = 0;
  double kinetic_translation = 0, kinetic_rotation = 0, gravity = 0, gravity_work = 0;
  double largest_overlap = 0;
  std::uint32_t overlap_i = 0, overlap_j = 0;  // spheres; j = ~part for a wall
  std::uint64_t touching = 0;
  bool stale = false, bad = false;
  std::uint32_t bad_particle = 0;
  std::vector<std::uint32_t> outside;
  std::vector<Wrench> load;  // on each part
};

/// Which numbers of a particle are not finite or beyond 1e30, and where it is, or where its first sphere was when the
/// lists were built if that is no place: "velocity y, spin x, at (0, 0, 0.1) m".
std::string bad_motion(const Record& particle, const Vec3& listed);

inline double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace calx
