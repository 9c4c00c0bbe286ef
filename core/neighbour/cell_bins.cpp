// cell_bins.cpp: the levels of a search, and spheres in the order of their cells.
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/hot.hpp"
#include "neighbour/cell_compare.hpp"
#include "neighbour/cell_levels.hpp"

namespace calx {
namespace {

/// Cells per sphere of a level above which it is folded, and what it then has at least.
constexpr std::uint64_t kMostCells = 8, kFoldedCells = 4;
constexpr std::uint64_t kFewestCells = 1024;
/// Spheres below which threads do not pay.
constexpr std::size_t kParallel = 4096;

using Signed = std::int32_t __attribute__((vector_size(16)));
using Unsigned = std::uint32_t __attribute__((vector_size(16)));

/// Cell coordinates of a position, the fourth of no meaning. Each rises with its coordinate over all numbers; points
/// less than a cell apart differ by one at most.
__attribute__((always_inline)) inline void cell_coordinates(const Doubles& x, const Doubles& origin, double inverse,
                                                            Unsigned& cell) {
  Doubles c = (x - origin) * inverse;
  constexpr double h = kHalfRange;
  c = c < h ? c : Doubles{h, h, h, h};
  c = c > -h ? c : Doubles{-h, -h, -h, -h};
  cell = (Unsigned) __builtin_convertvector(c + h, Signed);
}

/// Position of a sphere, in the box along periodic directions, and a fourth value.
__attribute__((always_inline)) inline void load_inside(const Wrap& wrap, bool wraps, const Record& s, Doubles& x) {
  std::memcpy(&x, &s.x, sizeof x);
  if (!wraps) return;
  for (int k = 0; k < 3; ++k)
    if (wrap.periodic[static_cast<std::size_t>(k)]) x[k] = wrap.inside(x[k], k);
}

/// Spheres as they come: position, radius, margin and half of the gap at which laws act.
struct Spheres {
  const Record* s;
  const std::uint32_t* owner;  // null: each its own
  const double* margin;
  Wrap wrap;
  bool wraps;
  double half_gap;
  double reach(std::size_t k) const { return s[k].r + margin[owner ? owner[k] : k] + half_gap; }
};

struct Extent {
  double low[4] = {1e300, 1e300, 1e300, 1e300}, high[4] = {-1e300, -1e300, -1e300, -1e300};  // m; of three each
  double smallest = 1e300, largest = 0;                                                      // reach, m
  void add(const Extent& b) {
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], b.low[d]);
      high[d] = std::max(high[d], b.high[d]);
    }
    smallest = std::min(smallest, b.smallest);
    largest = std::max(largest, b.largest);
  }
};

CALX_HOT void measure_extent(const Spheres& all, std::size_t first, std::size_t last, Extent& out) {
  const Spheres v = all;
  Extent e;
  Doubles low, high, x;
  std::memcpy(&low, e.low, sizeof low);
  std::memcpy(&high, e.high, sizeof high);
  for (std::size_t k = first; k < last; ++k) {
    load_inside(v.wrap, v.wraps, v.s[k], x);
    low = x < low ? x : low;
    high = x > high ? x : high;
    const double reach = v.reach(k);
    e.smallest = reach < e.smallest ? reach : e.smallest;
    e.largest = reach > e.largest ? reach : e.largest;
  }
  std::memcpy(e.low, &low, sizeof low);
  std::memcpy(e.high, &high, sizeof high);
  out = e;
}

/// Cell of each sphere in the tables of all levels, and how many were in it before.
CALX_HOT void count_cells(const Spheres& all, const CellSearch::Level* levels, const Vec3& centre, std::size_t first,
                          std::size_t last, bool alone, std::uint32_t* cell_start, std::uint32_t* cell_of,
                          std::uint32_t* number) {
  const Spheres v = all;
  const Doubles origin{centre.x, centre.y, centre.z, 0};
  for (std::size_t k = first; k < last; ++k) {
    const double reach = v.reach(k);
    const CellSearch::Level* g = levels;
    while (reach > g->reach) ++g;
    Doubles x;
    Unsigned cell, low, stride;
    load_inside(v.wrap, v.wraps, v.s[k], x);
    cell_coordinates(x, origin, g->inverse, cell);
    std::memcpy(&low, g->low, sizeof low);
    std::memcpy(&stride, g->stride, sizeof stride);
    cell = (cell - low) * stride;
    const std::uint32_t at = g->start + ((cell[0] + cell[1] + cell[2]) & g->mask);
    cell_of[k] = at;
    if (alone) {
      number[k] = cell_start[at]++;
    } else {
      std::uint32_t before;
#pragma omp atomic capture
      before = cell_start[at]++;
      number[k] = before;
    }
  }
}

/// Calls work(block, first, last) for equal parts of n spheres, one for each thread.
template <class Work>
void in_blocks(std::size_t n, std::size_t blocks, Work work) {
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (std::size_t b = 0; b < blocks; ++b) work(b, n * b / blocks, n * (b + 1) / blocks);
}

std::size_t blocks_for(std::size_t n) { return n < kParallel ? 1 : static_cast<std::size_t>(omp_get_max_threads()); }

/// Strides and size of the table of a level of count spheres.
void lay_out(CellSearch::Level& g, std::uint64_t count) {
  std::uint64_t extent[3];
  // One empty cell between rows and between layers, and three at least, so that no cell is its own neighbour.
  for (int k = 0; k < 3; ++k) extent[k] = std::max<std::uint64_t>(g.high[k] - g.low[k] + std::uint64_t{2}, 3);
  const double all = static_cast<double>(extent[0]) * static_cast<double>(extent[1]) * static_cast<double>(extent[2]);
  const std::uint64_t most = std::max<std::uint64_t>(4 * kFewestCells, kMostCells * count);
  std::uint64_t cells = kFewestCells;
  while (cells < most && static_cast<double>(cells) < all) cells *= 2;
  if (static_cast<double>(cells) >= all) {
    g.stride[0] = 1;
    g.stride[1] = static_cast<std::uint32_t>(extent[0]);
    g.stride[2] = static_cast<std::uint32_t>(extent[0] * extent[1]);
    g.folded = false;
  } else {
    // Odd strides near the powers of the third root: blocks of cells up to about that size do not meet themselves.
    cells = kFewestCells;
    while (cells < kFoldedCells * count) cells *= 2;
    const double side = std::cbrt(static_cast<double>(cells));
    g.stride[0] = 1;
    g.stride[1] = static_cast<std::uint32_t>(side) | 1;
    g.stride[2] = static_cast<std::uint32_t>(side * side) | 1;
    g.folded = true;
  }
  g.mask = static_cast<std::uint32_t>(cells - 1);
}

}  // namespace

void CellSearch::measure(const Particles& p, const Wrap& wrap, const Column<double>& margin) {
  const std::size_t n = p.sphere_count(), blocks = blocks_for(n);
  const Spheres spheres{p.spheres(), p.has_clumps ? p.owner.data() : nullptr, margin.data(), wrap, wrap.any(),
                        half_gap_};
  std::vector<Extent> extents(blocks);
  in_blocks(n, blocks, [&](std::size_t b, std::size_t first, std::size_t last) {
    measure_extent(spheres, first, last, extents[b]);
  });
  Extent extent;
  for (const Extent& e : extents) extent.add(e);
  // The middle of some spheres, so that a stray one does not take the digits from the others.
  std::vector<double> sample[3];
  for (std::size_t k = 0; k < n; k += n / 16 + 1)
    for (int d = 0; d < 3; ++d) sample[d].push_back(position(spheres.s[k])[d]);
  for (int d = 0; d < 3; ++d) {
    const auto middle = sample[d].begin() + static_cast<std::ptrdiff_t>(sample[d].size() / 2);
    std::nth_element(sample[d].begin(), middle, sample[d].end());
    origin_[d] = *middle;
  }

  const ReachClasses classes(extent.smallest, extent.largest);
  std::vector<ReachClasses::Class> found(classes.class_count());
  if (found.size() == 1) {
    found[0] = {n, extent.largest};
  } else {
    std::vector<std::vector<ReachClasses::Class>> parts(blocks, found);
    in_blocks(n, blocks, [&](std::size_t b, std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        const double reach = spheres.reach(k);
        ReachClasses::Class& c = parts[b][classes.class_of(reach)];
        ++c.count;
        c.largest = std::max(c.largest, reach);
      }
    });
    for (const auto& part : parts)
      for (std::size_t c = 0; c < found.size(); ++c) {
        found[c].count += part[c].count;
        found[c].largest = std::max(found[c].largest, part[c].largest);
      }
  }
  levels_.clear();
  std::uint32_t start = 0;
  for (const double reach : choose_levels(found)) {
    Level g;
    g.reach = reach;
    g.cell = reach > 0 ? 2 * reach * (1 + kRoundingShare) : 1;
    g.inverse = 1 / g.cell;
    Unsigned low, high;
    Doubles x, origin{origin_.x, origin_.y, origin_.z, 0};
    std::memcpy(&x, extent.low, sizeof x);
    cell_coordinates(x, origin, g.inverse, low);
    std::memcpy(&x, extent.high, sizeof x);
    cell_coordinates(x, origin, g.inverse, high);
    std::memcpy(g.low, &low, sizeof low);
    std::memcpy(g.high, &high, sizeof high);
    std::uint64_t count = 0;
    for (const auto& c : found)
      if (c.largest <= reach && (levels_.empty() || c.largest > levels_.back().reach)) count += c.count;
    lay_out(g, count);
    g.start = start;
    start += g.mask + 4;
    levels_.push_back(g);
  }
  cell_start_.assign(start, 0);
  repeats_ = false;
  for (const Level& g : levels_) repeats_ = repeats_ || (g.folded && (wrap.any() || levels_.size() > 1));
  for (int d = 0; d < 3; ++d)
    if (wrap.periodic[static_cast<std::size_t>(d)] && wrap.length[d] < 4.01 * extent.largest) repeats_ = true;
}

namespace {

/// Replaces counts by the sum of those before, from `sum` on; returns the sum of all.
std::uint32_t sum_up(std::uint32_t* counts, std::size_t n, std::uint32_t sum) {
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t c = counts[k];
    counts[k] = sum;
    sum += c;
  }
  return sum;
}

std::uint32_t sum_up_on_threads(std::uint32_t* counts, std::size_t n, std::uint32_t sum) {
  const std::size_t blocks = blocks_for(n / 8);
  if (blocks == 1) return sum_up(counts, n, sum);
  std::vector<std::uint32_t> before(blocks + 1, sum);
  in_blocks(n, blocks, [&](std::size_t b, std::size_t first, std::size_t last) {
    std::uint32_t total = 0;
    for (std::size_t k = first; k < last; ++k) total += counts[k];
    before[b + 1] = total;
  });
  for (std::size_t b = 0; b < blocks; ++b) before[b + 1] += before[b];
  in_blocks(n, blocks, [&](std::size_t b, std::size_t first, std::size_t last) {
    sum_up(counts + first, last - first, before[b]);
  });
  return before[blocks];
}

}  // namespace

void CellSearch::bin(const Particles& p, const Wrap& wrap, const Column<double>& margin) {
  const std::size_t n = p.sphere_count(), blocks = blocks_for(n);
  const Spheres spheres{p.spheres(), p.has_clumps ? p.owner.data() : nullptr, margin.data(), wrap, wrap.any(),
                        half_gap_};
  cell_of_.resize(n);
  place_.resize(n);
  // First the number of a sphere within its cell. Threads may number them in any order: it shows in no result.
  in_blocks(n, blocks, [&](std::size_t, std::size_t first, std::size_t last) {
    count_cells(spheres, levels_.data(), origin_, first, last, blocks == 1, cell_start_.data(), cell_of_.data(),
                place_.data());
  });
  std::uint32_t sum = 0;
  for (Level& g : levels_) {
    std::uint32_t* start = &cell_start_[g.start];
    const std::size_t cells = g.mask + std::size_t{1};
    g.first = sum;
    g.last = sum_up_on_threads(start, cells, sum);
    start[cells] = g.last;
    start[cells + 1] = g.last + start[1] - start[0];
    start[cells + 2] = sum = g.last + start[2] - start[0];
  }
  // The last eight compared may reach beyond the end.
  for (auto* c : {&x_, &y_, &z_, &reach_}) c->resize(sum + 8);
  rank_.resize(sum + 8);
  in_blocks(n, blocks, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t at = place_[k] += cell_start_[cell_of_[k]];
      Doubles x;
      load_inside(wrap, spheres.wraps, spheres.s[k], x);
      x_[at] = x[0];
      y_[at] = x[1];
      z_[at] = x[2];
      reach_[at] = spheres.reach(k);
      rank_[at] = static_cast<std::uint32_t>(k);
    }
  });
  for (const Level& g : levels_) {
    const std::uint32_t* start = &cell_start_[g.start];
    for (std::uint32_t b = start[0]; b < start[2]; ++b) {
      const std::uint32_t to = g.last + b - g.first;
      for (auto* c : {&x_, &y_, &z_, &reach_}) (*c)[to] = (*c)[b];
      rank_[to] = rank_[b];
    }
  }
}

}  // namespace calx
