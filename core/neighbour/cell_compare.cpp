#include "neighbour/cell_compare.hpp"

#include <cstring>

#include "base/hot.hpp"

namespace calx {
namespace {

using Bits = std::int64_t __attribute__((vector_size(32)));

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

}  // namespace

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

}  // namespace calx
