// cell_compare.hpp: comparing spheres with those of the cells around them. Private to neighbour/.
#pragma once
#include <cstdint>
#include <vector>

#include "neighbour/cell_search.hpp"

namespace calx {

using Doubles = double __attribute__((vector_size(32)));

/// Cells are wider than the largest pair distance by this share, above the rounding of cell coordinates.
constexpr double kRoundingShare = 1e-6;
/// Cell coordinates are counted from origin - kHalfRange cells; what is farther away counts as there.
constexpr double kHalfRange = 1e9;

/// What the comparisons read, as plain pointers.
struct CellSearch::View {
  const double *x, *y, *z, *reach;
  const std::uint32_t *rank, *cell_start, *cell_of, *place, *owner;
  const Level* levels;
  std::uint32_t level_count;
  Vec3 origin;
  Wrap wrap;
  bool wraps;
};

/// Where pairs go: lower rank << 32 | higher.
struct Found {
  std::vector<std::uint64_t>& pairs;
  std::vector<std::uint64_t>& foreign;  // of a lower sphere before the run
  std::uint32_t* count;                 // pairs of each lower sphere, from `first` on
  std::uint32_t first;
  std::uint64_t *at, *limit;  // next free entry, and the last before which there is room for a call of keep_all
};

/// Pairs kept between two calls of make_room, at most.
constexpr std::size_t kRoom = 64;

/// Spheres first .. last with all that stand later in their level.
void search_own_level(const CellSearch::View& view, std::uint32_t first, std::uint32_t last, Found& to);
/// Spheres first .. last with those of finer levels, and with periodic images of their own.
void search_windows(const CellSearch::View& view, std::uint32_t first, std::uint32_t last, Found& to);

}  // namespace calx
