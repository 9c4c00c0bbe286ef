// engine_detail.hpp: work spaces shared by the passes of a step. Private to step/.
#pragma once
#include <chrono>
#include <vector>

#include "base/hot.hpp"
#include "step/engine.hpp"

namespace calx {

/// Rows a block of contacts carries beside what a law sees.
struct Engine::Worker {
  explicit Worker(std::uint32_t state_columns) : scratch(state_columns) {}
  BlockScratch scratch;
  alignas(64) std::uint32_t entry[kBlockRows];    // of the tile, relative to its first entry
  alignas(64) std::uint32_t ordinal[kBlockRows];  // number of entries before this one that leave the chunk
  alignas(64) std::uint32_t i[kBlockStride], j[kBlockStride];
  alignas(64) std::uint32_t bucket[kBlockRows], picked[kBlockRows], picked_ordinal[kBlockRows];
  // Differences of positions, radii, masses and lever arms of a block.
  alignas(64) double dx[kBlockStride], dy[kBlockStride], dz[kBlockStride];
  alignas(64) double ri[kBlockStride], rj[kBlockStride], mi[kBlockStride], mj[kBlockStride];
  alignas(64) double wix[kBlockStride], wiy[kBlockStride], wiz[kBlockStride];
  alignas(64) double wjx[kBlockStride], wjy[kBlockStride], wjz[kBlockStride];
  alignas(64) double arm_i[kBlockStride], arm_j[kBlockStride];
  alignas(64) double gx[kBlockStride], gy[kBlockStride], gz[kBlockStride];
  std::size_t tile = 0;        // first entry of the tile
  std::size_t cross_done = 0;  // entries of the chunk before the tile that leave it
  // Wall block.
  std::uint32_t wall_count = 0;
  const LawList* wall_law = nullptr;
  std::uint32_t wall_part[kBlockRows];
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

inline double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace calx
