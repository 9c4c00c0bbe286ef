#include "neighbour/cell_search.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/hot.hpp"
#include "neighbour/cell_levels.hpp"

namespace calx {
namespace {

/// Cells are wider than the largest pair distance by this share, above the rounding of cell coordinates.
constexpr double kRoundingShare = 1e-6;
/// Cell coordinates are counted from origin - kHalfRange cells; what is farther away counts as there.
constexpr double kHalfRange = 1e9;
/// Cells per sphere of a level above which it is folded, and what it then has at least.
constexpr std::uint64_t kMostCells = 8, kFoldedCells = 4;
constexpr std::uint64_t kFewestCells = 1024;
/// Spheres below which threads do not pay.
constexpr std::size_t kParallel = 4096;

using Doubles = double __attribute__((vector_size(32)));
using Bits = std::int64_t __attribute__((vector_size(32)));
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

/// Spheres as they come: position, radius and margin.
struct Spheres {
  const Record* s;
  const std::uint32_t* owner;  // null: each its own
  const double* margin;
  Wrap wrap;
  bool wraps;
  double reach(std::size_t k) const { return s[k].r + margin[owner ? owner[k] : k]; }
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

namespace {

struct Query {
  Doubles x, y, z, reach;  // each four times the same
};

__attribute__((always_inline)) inline Query query(const CellSearch::View& v, std::uint32_t p) {
  const double x = v.x[p], y = v.y[p], z = v.z[p], r = v.reach[p];
  return {Doubles{x, x, x, x}, Doubles{y, y, y, y}, Doubles{z, z, z, z}, Doubles{r, r, r, r}};
}

/// All bits of lane k are set where the sphere of place b + k is within reach.
__attribute__((always_inline)) inline void near_four(const CellSearch::View& v, std::size_t b, const Query& q,
                                                     Bits& near) {
  Doubles x, y, z, cut;
  std::memcpy(&x, v.x + b, sizeof x);
  std::memcpy(&y, v.y + b, sizeof y);
  std::memcpy(&z, v.z + b, sizeof z);
  std::memcpy(&cut, v.reach + b, sizeof cut);
  x = q.x - x;
  y = q.y - y;
  z = q.z - z;
  cut = q.reach + cut;
  near = x * x + y * y + z * z < cut * cut;
}

/// Sets bits `shift` to `shift` + 7 for the eight spheres from place b on.
__attribute__((always_inline)) inline void near_eight(const CellSearch::View& v, std::size_t b, const Query& q,
                                                      int shift, Bits& bits) {
  Bits lower, upper;
  near_four(v, b, q, lower);
  near_four(v, b + 4, q, upper);
  bits |= ((lower & Bits{1, 2, 4, 8}) | (upper & Bits{16, 32, 64, 128})) << shift;
}

__attribute__((always_inline)) inline std::uint64_t united(const Bits& b) {
  return static_cast<std::uint64_t>((b[0] | b[2]) | (b[1] | b[3]));
}

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
__attribute__((noinline)) std::uint64_t* grow(std::vector<std::uint64_t>& pairs, std::uint64_t* at) {
  const auto used = at - pairs.data();
  pairs.resize(2 * pairs.size() + 4 * kRoom);
  return pairs.data() + used;
}
__attribute__((always_inline)) inline void make_room(Found& out) {
  if (out.at < out.limit) return;
  out.at = grow(out.pairs, out.at);
  out.limit = out.pairs.data() + (out.pairs.size() - kRoom);
}
__attribute__((noinline)) void add(std::vector<std::uint64_t>& foreign, std::uint64_t pair) { foreign.push_back(pair); }

__attribute__((always_inline)) inline void keep(const CellSearch::View& v, Found& out, std::uint32_t k,
                                                std::uint32_t own, std::uint32_t j) {
  if (v.owner && v.owner[j] == own) return;
  const std::uint32_t lo = j < k ? j : k, hi = j < k ? k : j;
  const std::uint64_t pair = static_cast<std::uint64_t>(lo) << 32 | hi;
  if (lo < out.first) {
    add(out.foreign, pair);
    return;
  }
  ++out.count[lo - out.first];
  *out.at++ = pair;
}

/// Places begin .. end against q. only_higher: partners of lower rank find k themselves.
__attribute__((always_inline)) inline void compare(const CellSearch::View& v, Found& out, std::uint32_t begin,
                                                   std::uint32_t end, const Query& q, std::uint32_t k,
                                                   std::uint32_t own, bool only_higher) {
  while (begin < end) {
    const std::uint32_t n = end - begin < 64 ? end - begin : 64;
    Bits near{};
    for (std::uint32_t b = 0; b < n; b += 8) near_eight(v, begin + b, q, static_cast<int>(b), near);
    make_room(out);
    for (std::uint64_t bits = united(near) & (~std::uint64_t{0} >> (64 - n)); bits; bits &= bits - 1) {
      const std::uint32_t j = v.rank[begin + static_cast<std::uint32_t>(__builtin_ctzll(bits))];
      if (only_higher && j <= k) continue;
      keep(v, out, k, own, j);
    }
    begin += n;
  }
}

/// All cells of a level that q can reach.
__attribute__((always_inline)) inline void window(const CellSearch::View& v, const CellSearch::Level& g, Found& out,
                                                  const Query& q, std::uint32_t k, std::uint32_t own,
                                                  bool only_higher) {
  // In cells, with slack for the rounding of both spheres' coordinates.
  const double far = (q.reach[0] + g.reach) * g.inverse + kRoundingShare;
  const double at[3] = {(q.x[0] - v.origin.x) * g.inverse + kHalfRange, (q.y[0] - v.origin.y) * g.inverse + kHalfRange,
                        (q.z[0] - v.origin.z) * g.inverse + kHalfRange};
  std::uint32_t first[3] = {}, last[3] = {};
  bool ranged = true;
  for (int d = 0; d < 3; ++d) {
    // Spheres beyond the range of coordinates stand in its outermost cells.
    if (!(at[d] - far >= 1 && at[d] + far < 2 * kHalfRange)) {
      ranged = false;
      continue;
    }
    first[d] = static_cast<std::uint32_t>(at[d] - far);
    last[d] = static_cast<std::uint32_t>(at[d] + far);
    if (last[d] < g.low[d] || first[d] > g.high[d]) return;
    first[d] = first[d] > g.low[d] ? first[d] : g.low[d];
    last[d] = last[d] < g.high[d] ? last[d] : g.high[d];
  }
  if (!ranged || (1.0 + last[1] - first[1]) * (1.0 + last[2] - first[2]) * 8 > g.last - g.first) {
    compare(v, out, g.first, g.last, q, k, own, only_higher);
    return;
  }
  const std::uint32_t* start = v.cell_start + g.start;
  const double first_x = first[0], last_x = last[0];
  auto gap2 = [](double c, double x) {
    const double below = c - x, above = x - 1 - c, gap = below > above ? below : above;
    return gap > 0 ? gap * gap : 0;
  };
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    const double rest_z = far * far - gap2(z, at[2]);
    const std::uint32_t layer = (z - g.low[2]) * g.stride[2] - g.low[0];
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      const double rest = rest_z - gap2(y, at[1]);
      if (rest < 0) continue;
      const double chord = __builtin_sqrt(rest) + kRoundingShare;
      const auto from = static_cast<std::uint32_t>(at[0] - chord > first_x ? at[0] - chord : first_x);
      const auto to = static_cast<std::uint32_t>(at[0] + chord < last_x ? at[0] + chord : last_x);
      if (to < from) continue;
      std::uint32_t cell = layer + (y - g.low[1]) * g.stride[1] + from;
      // A row may run over the end of a folded table.
      for (std::uint32_t left = to - from + 1; left > 0;) {
        cell &= g.mask;
        const std::uint32_t part = left < g.mask + 1 - cell ? left : g.mask + 1 - cell;
        compare(v, out, start[cell], start[cell + part], q, k, own, only_higher);
        cell += part;
        left -= part;
      }
    }
  }
}

/// Later cells of the sphere's own level: the rest of its cell and the next of its row, and four rows of three.
__attribute__((always_inline)) inline void later_cells(const CellSearch::View& v, const CellSearch::Level& g,
                                                       Found& out, const Query& q, std::uint32_t k, std::uint32_t own) {
  const std::uint32_t* start = v.cell_start + g.start;
  const std::uint32_t cell = v.cell_of[k] - g.start, sy = g.stride[1], sz = g.stride[2];
  const std::uint32_t rows[4] = {cell + sy - 1, cell + sz - sy - 1, cell + sz - 1, cell + sz + sy - 1};
  std::uint32_t begin[5], end[5];
  begin[0] = v.place[k] + 1;
  end[0] = start[cell + 2];
  Bits near{};
  near_eight(v, begin[0], q, 0, near);
  std::int32_t left = 8 - static_cast<std::int32_t>(end[0] - begin[0]);
#pragma GCC unroll 4
  for (int r = 1; r < 5; ++r) {
    const std::uint32_t c = rows[r - 1] & g.mask;
    begin[r] = start[c];
    end[r] = start[c + 3];
    near_eight(v, begin[r], q, 8 * r, near);
    left |= 8 - static_cast<std::int32_t>(end[r] - begin[r]);
  }
  make_room(out);
  for (std::uint64_t bits = united(near); bits; bits &= bits - 1) {
    const int bit = __builtin_ctzll(bits);
    const std::uint32_t at = begin[bit >> 3] + static_cast<std::uint32_t>(bit & 7);
    if (at < end[bit >> 3]) keep(v, out, k, own, v.rank[at]);
  }
  // Negative: a row of more than eight.
  if (left < 0)
    for (int r = 0; r < 5; ++r)
      if (end[r] - begin[r] > 8) compare(v, out, begin[r] + 8, end[r], q, k, own, false);
}

/// Spheres first .. last with all that stand later in their level.
CALX_HOT void search_own_level(const CellSearch::View& view, std::uint32_t first, std::uint32_t last, Found& to) {
  // Copies, which no store below can change.
  const CellSearch::View v = view;
  Found out = to;
  for (std::uint32_t k = first; k < last; ++k) {
    const std::uint32_t p = v.place[k], own = v.owner ? v.owner[k] : k;
    const CellSearch::Level* g = v.levels;
    while (p >= g->last) ++g;
    later_cells(v, *g, out, query(v, p), k, own);
  }
  to.at = out.at;
  to.limit = out.limit;
}

/// Spheres first .. last with those of finer levels, and with periodic images of their own.
CALX_HOT void search_windows(const CellSearch::View& view, std::uint32_t first, std::uint32_t last, Found& to) {
  const CellSearch::View v = view;
  Found out = to;
  for (std::uint32_t k = first; k < last; ++k) {
    const std::uint32_t p = v.place[k], own = v.owner ? v.owner[k] : k;
    std::uint32_t level = 0;
    while (p >= v.levels[level].last) ++level;
    const double at[3] = {v.x[p], v.y[p], v.z[p]};
    for (std::uint32_t g = v.wraps ? level + 1 : level; g-- > 0;) {
      const double far = (v.reach[p] + v.levels[g].reach) * (1 + kRoundingShare);
      // Images that can reach the box: shifts by -1, 0, 1 lengths along each direction.
      int lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};
      for (int d = 0; d < 3; ++d) {
        if (!v.wrap.periodic[static_cast<std::size_t>(d)]) continue;
        const double below = at[d] - v.wrap.lo[d];
        if (v.wrap.length[d] - below < far) lower[d] = -1;
        if (below < far) upper[d] = 1;
      }
      for (int c = lower[2]; c <= upper[2]; ++c)
        for (int b = lower[1]; b <= upper[1]; ++b)
          for (int a = lower[0]; a <= upper[0]; ++a) {
            if (g == level && !a && !b && !c) continue;
            Query q = query(v, p);
            q.x += a * v.wrap.length.x;
            q.y += b * v.wrap.length.y;
            q.z += c * v.wrap.length.z;
            window(v, v.levels[g], out, q, k, own, g == level);
          }
    }
  }
  to.at = out.at;
  to.limit = out.limit;
}

}  // namespace

void CellSearch::measure(const Particles& p, const Wrap& wrap, const Column<double>& margin) {
  const std::size_t n = p.sphere_count(), blocks = blocks_for(n);
  const Spheres spheres{p.spheres(), p.has_clumps ? p.owner.data() : nullptr, margin.data(), wrap, wrap.any()};
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
  const Spheres spheres{p.spheres(), p.has_clumps ? p.owner.data() : nullptr, margin.data(), wrap, wrap.any()};
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

namespace {

using Eight = std::int32_t __attribute__((vector_size(32)));

/// Sorts rows of count[k] ranks from `rows` to `out`; eight more may be read. Ranks are below 2^31.
CALX_HOT void sort_rows(const std::uint32_t* rows, const std::uint32_t* count, std::size_t n, bool repeats,
                        std::uint32_t* out) {
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t length = count[k];
    if (length <= 8 && !repeats) {
      // The place of each is the number of smaller ones.
      Eight row, at{};
      std::memcpy(&row, rows, sizeof row);
      for (std::uint32_t m = 0; m < length; ++m) at -= row > static_cast<std::int32_t>(rows[m]);
      std::int32_t place[8];
      std::memcpy(place, &at, sizeof place);
      for (std::uint32_t m = 0; m < length; ++m) out[place[m]] = rows[m];
    } else {
      std::copy(rows, rows + length, out);
      std::sort(out, out + length);
    }
    rows += length;
    out += length;
  }
}

}  // namespace

void CellSearch::collect(std::size_t found, Scratch& scratch, Run& run) const {
  const std::size_t n = run.count.size();
  // Where the next partner of each sphere goes.
  scratch.next.resize(n);
  scratch.rows.resize(std::max(scratch.rows.size(), found + 8));
  std::uint32_t *const next = scratch.next.data(), *const rows = scratch.rows.data();
  const std::uint32_t* const count = run.count.data();
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    next[k] = sum;
    sum += count[k];
  }
  const std::uint32_t first = scratch.first;
  const std::uint64_t* const pairs = scratch.pairs.data();
  for (std::size_t e = 0; e < found; ++e)
    rows[next[static_cast<std::uint32_t>(pairs[e] >> 32) - first]++] = static_cast<std::uint32_t>(pairs[e]);
  run.partner.resize(found);
  sort_rows(rows, count, n, repeats_, run.partner.data());
}

void CellSearch::merge(const std::vector<std::uint64_t>& gained, std::uint32_t first, Run& run) {
  // From the last row to the first, so that each partner moves once: those from `end` on have moved up to `to`.
  std::size_t end = run.partner.size(), to = end + gained.size(), row_end = end, g = gained.size();
  run.partner.resize(to);
  const auto partner = run.partner.begin();
  auto at = [&](std::size_t k) { return partner + static_cast<std::ptrdiff_t>(k); };
  for (std::size_t k = run.count.size(); g > 0; --k) {
    const std::size_t row = row_end - run.count[k - 1];
    for (; g > 0 && gained[g - 1] >> 32 == first + k - 1; --g, ++run.count[k - 1]) {
      const auto j = static_cast<std::uint32_t>(gained[g - 1]);
      const auto above = std::lower_bound(at(row), at(std::min(row_end, end)), j);
      std::copy_backward(above, at(end), at(to));
      to -= static_cast<std::size_t>(at(end) - above) + 1;
      end = static_cast<std::size_t>(above - partner);
      *at(to) = j;
    }
    row_end = row;
  }
}

void CellSearch::drop_repeats(Run& run) {
  auto row = run.partner.begin(), to = row;
  for (auto& count : run.count) {
    const auto row_end = row + count;
    const auto end = std::unique(row, row_end);
    count = static_cast<std::uint32_t>(end - row);
    to = std::copy(row, end, to);
    row = row_end;
  }
  run.partner.erase(to, run.partner.end());
}

void CellSearch::find(const Particles& p, const Wrap& wrap, const Column<double>& margin,
                      const std::vector<std::uint32_t>& run_start) {
  const std::size_t runs = run_start.size() - 1;
  if (runs_.size() < runs) {
    runs_.resize(runs);
    foreign_.resize(runs);
  }
  if (p.sphere_count() == 0) return;
  measure(p, wrap, margin);
  bin(p, wrap, margin);
  const View view{x_.data(),
                  y_.data(),
                  z_.data(),
                  reach_.data(),
                  rank_.data(),
                  cell_start_.data(),
                  cell_of_.data(),
                  place_.data(),
                  p.has_clumps ? p.owner.data() : nullptr,
                  levels_.data(),
                  static_cast<std::uint32_t>(levels_.size()),
                  origin_,
                  wrap,
                  wrap.any()};
  scratch_.resize(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t r = 0; r < runs; ++r) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
    scratch.first = run_start[r];
    runs_[r].count.assign(run_start[r + 1] - run_start[r], 0);
    foreign_[r].clear();
    if (scratch.pairs.size() < kRoom) scratch.pairs.resize(kRoom);
    Found found{scratch.pairs, foreign_[r],          runs_[r].count.data(),
                scratch.first, scratch.pairs.data(), scratch.pairs.data() + (scratch.pairs.size() - kRoom)};
    search_own_level(view, run_start[r], run_start[r + 1], found);
    if (levels_.size() > 1 || view.wraps) search_windows(view, run_start[r], run_start[r + 1], found);
    collect(static_cast<std::size_t>(found.at - scratch.pairs.data()), scratch, runs_[r]);
    std::sort(foreign_[r].begin(), foreign_[r].end());
  }
  // Pairs found from the sphere of higher rank belong to the run of the other.
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t r = 0; r < runs; ++r) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
    auto& gained = scratch.pairs;
    gained.clear();
    for (std::size_t from = r + 1; from < runs; ++from) {
      const auto& all = foreign_[from];
      const auto begin = std::lower_bound(all.begin(), all.end(), static_cast<std::uint64_t>(run_start[r]) << 32);
      const auto end = std::lower_bound(begin, all.end(), static_cast<std::uint64_t>(run_start[r + 1]) << 32);
      gained.insert(gained.end(), begin, end);
    }
    std::sort(gained.begin(), gained.end());
    merge(gained, run_start[r], runs_[r]);
    if (repeats_) drop_repeats(runs_[r]);
  }
}

std::size_t CellSearch::memory_bytes() const {
  std::size_t bytes = (cell_start_.capacity() + cell_of_.capacity() + place_.capacity() + rank_.capacity()) * 4;
  bytes += (x_.capacity() + y_.capacity() + z_.capacity() + reach_.capacity()) * 8;
  for (const auto& r : runs_) bytes += (r.count.capacity() + r.partner.capacity()) * 4;
  for (const auto& f : foreign_) bytes += f.capacity() * 8;
  for (const auto& s : scratch_) bytes += s.pairs.capacity() * 8 + (s.next.capacity() + s.rows.capacity()) * 4;
  return bytes;
}

}  // namespace calx
