// pair_list.cpp: cell lists, pair search and carrying history from the old list to the new.
#include "neighbour/pair_list.hpp"

#include <algorithm>
#include <cmath>

namespace calx {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// Particles per chunk: many, so that little crosses; about 32 chunks, so that 8 threads share well.
std::uint32_t chunk_length(std::size_t particle_count) {
  const std::size_t even = (particle_count + 31) / 32;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(even, 256, 4096));
}

std::uint64_t spread(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x1F00000000FFFFull;
  v = (v | v << 16) & 0x1F0000FF0000FFull;
  v = (v | v << 8) & 0x100F00F00F00F00Full;
  v = (v | v << 4) & 0x10C30C30C30C30C3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

/// Regular grid over all spheres.
struct Grid {
  Vec3 lo;
  std::array<std::int64_t, 3> n{1, 1, 1};
  std::array<double, 3> inverse{1, 1, 1};
  std::array<bool, 3> wraps{false, false, false};
  std::int64_t coordinate(double x, int k) const {
    const auto c = static_cast<std::int64_t>(std::floor((x - lo[k]) * inverse[static_cast<std::size_t>(k)]));
    const auto cells = n[static_cast<std::size_t>(k)];
    if (wraps[static_cast<std::size_t>(k)]) return ((c % cells) + cells) % cells;
    return std::clamp<std::int64_t>(c, 0, cells - 1);
  }
  std::size_t cell(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>((z * n[1] + y) * n[0] + x);
  }
  std::size_t cells() const { return static_cast<std::size_t>(n[0] * n[1] * n[2]); }
};

Grid make_grid(const Record* s, std::size_t count, const Wrap& wrap, double size) {
  Grid g;
  Box box;
  for (std::size_t k = 0; k < count; ++k) box.add(position(s[k]));
  // Few cells beyond the particles: a stray one must not cost memory.
  const double limit = std::cbrt(static_cast<double>(count) * 64 + 4e6);
  for (int k = 0; k < 3; ++k) {
    const auto u = static_cast<std::size_t>(k);
    const double lo = wrap.periodic[u] ? wrap.lo[k] : box.lo[k];
    const double length = wrap.periodic[u] ? wrap.length[k] : box.hi[k] - box.lo[k];
    g.lo[k] = lo;
    g.wraps[u] = wrap.periodic[u];
    double cells = std::floor(length / size);
    if (!wrap.periodic[u]) cells += 1;
    g.n[u] = static_cast<std::int64_t>(std::clamp(cells, 1.0, limit));
    const double h = wrap.periodic[u] ? length / static_cast<double>(g.n[u])
                                      : std::max(size, length / static_cast<double>(g.n[u]) * (1 + 1e-12));
    g.inverse[u] = 1 / h;
  }
  return g;
}

/// Cell numbers c - reach .. c + reach along one direction: as ranges, wrapped or cut, none twice.
struct Span {
  std::int64_t first[2] = {0, 0}, last[2] = {-1, -1};
  int parts = 0;
};
Span span_of(std::int64_t c, std::int64_t reach, std::int64_t n, bool wraps) {
  Span s;
  auto add = [&](std::int64_t a, std::int64_t b) {
    s.first[s.parts] = a;
    s.last[s.parts++] = b;
  };
  if (!wraps) {
    add(std::max<std::int64_t>(0, c - reach), std::min(n - 1, c + reach));
  } else if (2 * reach + 1 >= n) {
    add(0, n - 1);
  } else if (c - reach < 0) {
    add(0, c + reach);
    add(c - reach + n, n - 1);
  } else if (c + reach >= n) {
    add(c - reach, n - 1);
    add(0, c + reach - n);
  } else {
    add(c - reach, c + reach);
  }
  return s;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const Particles& particles, double cell) {
  const std::size_t n = particles.count();
  Box box;
  for (const auto& b : particles.body) box.add(position(b));
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 d = (position(particles.body[k]) - box.lo) / cell;
    keys[k] = {spread(static_cast<std::uint64_t>(d.x)) | spread(static_cast<std::uint64_t>(d.y)) << 1 |
                   spread(static_cast<std::uint64_t>(d.z)) << 2,
               static_cast<std::uint32_t>(k)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = keys[k].second;
  return order;
}

void PairList::make_chunks(const Particles& p) {
  const auto n = static_cast<std::uint32_t>(p.count());
  const std::uint32_t length = chunk_length(n);
  chunks.assign((n + length - 1) / length, Chunk{});
  for (std::uint32_t c = 0; c < chunks.size(); ++c) {
    Chunk& k = chunks[c];
    k.first_particle = c * length;
    k.last_particle = std::min(n, (c + 1) * length);
    k.first_sphere = p.has_clumps ? p.first_sphere[k.first_particle] : k.first_particle;
    k.last_sphere = p.has_clumps ? p.first_sphere[k.last_particle] : k.last_particle;
  }
  work_.resize(std::max(work_.size(), chunks.size()));
}

void PairList::build(const Particles& p, const Wrap& wrap, const Column<double>& margin, double smallest_margin,
                     const HistorySpec& spec, const std::uint32_t* old_rank) {
  const Record* s = p.spheres();
  const std::size_t n = p.sphere_count();
  make_chunks(p);

  double largest_radius = 0, largest_margin = smallest_margin;
  for (std::size_t k = 0; k < n; ++k) largest_radius = std::max(largest_radius, s[k].r);
  for (const double m : margin) largest_margin = std::max(largest_margin, m);
  const double size = 2 * (largest_radius + smallest_margin);
  const Grid grid = make_grid(s, n, wrap, size > 0 ? size : 1);
  const auto wide = static_cast<std::int64_t>(std::ceil(2 * (largest_radius + largest_margin) / size));
  const double slow = smallest_margin * (1 + 1e-9);

  // Counting sort by cell; within a cell by rank.
  cell_of_.resize(n);
  cell_start_.assign(grid.cells() + 1, 0);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < n; ++k)
    cell_of_[k] = static_cast<std::uint32_t>(
        grid.cell(grid.coordinate(s[k].x, 0), grid.coordinate(s[k].y, 1), grid.coordinate(s[k].z, 2)));
  for (std::size_t k = 0; k < n; ++k) ++cell_start_[cell_of_[k] + 1];
  for (std::size_t c = 0; c < grid.cells(); ++c) cell_start_[c + 1] += cell_start_[c];
  binned_.resize(n);
  packed_.resize(n);
  {
    std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
    for (std::uint32_t k = 0; k < n; ++k) binned_[next[cell_of_[k]]++] = k;
  }
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < n; ++b) {
    const std::uint32_t k = binned_[b];
    packed_[b] = {s[k].x, s[k].y, s[k].z, s[k].r + margin[p.owner_of(k)]};
  }

  const bool wraps = wrap.any();
  // Calls visit(other) for spheres in cells within `reach` of k's cell, but outside `inner` cells when inner >= 0.
  auto search = [&](std::uint32_t k, std::int64_t reach, std::int64_t inner, double own_reach, auto&& visit) {
    const Vec3 x = position(s[k]);
    const std::int64_t c[3] = {grid.coordinate(x.x, 0), grid.coordinate(x.y, 1), grid.coordinate(x.z, 2)};
    const Span sx = span_of(c[0], reach, grid.n[0], grid.wraps[0]), sy = span_of(c[1], reach, grid.n[1], grid.wraps[1]),
               sz = span_of(c[2], reach, grid.n[2], grid.wraps[2]);
    auto outside = [&](std::int64_t a, int d) {
      std::int64_t gap = std::abs(a - c[d]);
      if (grid.wraps[static_cast<std::size_t>(d)]) gap = std::min(gap, grid.n[static_cast<std::size_t>(d)] - gap);
      return gap > inner;
    };
    auto test = [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t b = begin; b < end; ++b) {
        Vec3 d{packed_[b].x - x.x, packed_[b].y - x.y, packed_[b].z - x.z};
        if (wraps) d = wrap.nearest(d);
        const double cut = own_reach + packed_[b].reach;
        if (norm2(d) < cut * cut) visit(binned_[b]);
      }
    };
    for (int pz = 0; pz < sz.parts; ++pz)
      for (std::int64_t z = sz.first[pz]; z <= sz.last[pz]; ++z)
        for (int py = 0; py < sy.parts; ++py)
          for (std::int64_t y = sy.first[py]; y <= sy.last[py]; ++y)
            for (int px = 0; px < sx.parts; ++px) {
              if (inner < 0 || outside(z, 2) || outside(y, 1)) {
                test(cell_start_[grid.cell(sx.first[px], y, z)], cell_start_[grid.cell(sx.last[px], y, z) + 1]);
                continue;
              }
              for (std::int64_t a = sx.first[px]; a <= sx.last[px]; ++a)
                if (outside(a, 0)) test(cell_start_[grid.cell(a, y, z)], cell_start_[grid.cell(a, y, z) + 1]);
            }
  };

#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    ChunkWork& w = work_[c];
    w.partner.clear();
    w.extra.clear();
    w.row_count.assign(chunks[c].last_sphere - chunks[c].first_sphere, 0);
    for (std::uint32_t k = chunks[c].first_sphere; k < chunks[c].last_sphere; ++k) {
      const std::uint32_t own = p.owner_of(k);
      const double own_reach = s[k].r + margin[own];
      const std::size_t before = w.partner.size();
      search(k, 1, -1, own_reach, [&](std::uint32_t other) {
        if (other > k && p.owner_of(other) != own) w.partner.push_back(other);
      });
      w.row_count[k - chunks[c].first_sphere] = static_cast<std::uint32_t>(w.partner.size() - before);
      if (wide <= 1 || margin[own] <= slow) continue;
      search(k, wide, 1, own_reach, [&](std::uint32_t other) {
        const std::uint32_t theirs = p.owner_of(other);
        if (theirs == own || (margin[theirs] > slow && other < k)) return;
        w.extra.emplace_back(std::min(k, other), std::max(k, other));
      });
    }
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> extra;
  for (std::size_t c = 0; c < chunks.size(); ++c)
    extra.insert(extra.end(), work_[c].extra.begin(), work_[c].extra.end());
  std::sort(extra.begin(), extra.end());

  Column<std::size_t> old_row;
  old_row.swap(row_);
  Column<std::uint32_t> old_j;
  old_j.swap(j);
  Column<std::uint8_t> old_touching;
  old_touching.swap(touching);
  Column<double> old_history;
  old_history.swap(history);

  row_.assign(n + 1, 0);
  for (const auto& c : chunks)
    for (std::uint32_t k = c.first_sphere; k < c.last_sphere; ++k)
      row_[k + 1] = work_[static_cast<std::size_t>(&c - chunks.data())].row_count[k - c.first_sphere];
  for (const auto& e : extra) ++row_[e.first + 1];
  for (std::size_t k = 0; k < n; ++k) row_[k + 1] += row_[k];
  const std::size_t entries = row_[n];
  i.resize(entries);
  j.resize(entries);
  touching.assign(entries, 0);
  columns = spec.columns;
  history.resize(entries * columns + 4);  // rows are read four values at a time

#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    Chunk& chunk = chunks[c];
    const ChunkWork& w = work_[c];
    auto add = std::lower_bound(extra.begin(), extra.end(), std::make_pair(chunk.first_sphere, 0u));
    std::size_t from = 0;
    for (std::uint32_t k = chunk.first_sphere; k < chunk.last_sphere; ++k) {
      std::size_t e = row_[k];
      const std::uint32_t own = w.row_count[k - chunk.first_sphere];
      for (std::uint32_t m = 0; m < own; ++m) j[e++] = w.partner[from++];
      for (; add != extra.end() && add->first == k; ++add) j[e++] = add->second;
      std::sort(j.begin() + static_cast<std::ptrdiff_t>(row_[k]), j.begin() + static_cast<std::ptrdiff_t>(e));
      std::fill(i.begin() + static_cast<std::ptrdiff_t>(row_[k]), i.begin() + static_cast<std::ptrdiff_t>(e), k);
    }
    chunk.first_entry = row_[chunk.first_sphere];
    chunk.last_entry = row_[chunk.last_sphere];
  }
  if (!old_row.empty()) carry_history(spec, old_rank, old_row, old_j, old_touching, old_history);
  link_chunks();
}

void PairList::carry_history(const HistorySpec& spec, const std::uint32_t* old_rank, const Column<std::size_t>& old_row,
                             const Column<std::uint32_t>& old_j, const Column<std::uint8_t>& old_touching,
                             const Column<double>& old_history) {
  const auto old_count = static_cast<std::uint32_t>(old_row.size() - 1);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    for (std::size_t e = chunks[c].first_entry; e < chunks[c].last_entry; ++e) {
      const std::uint32_t a = old_rank ? old_rank[i[e]] : i[e], b = old_rank ? old_rank[j[e]] : j[e];
      if (a == kNone || b == kNone || a >= old_count || b >= old_count) continue;
      const std::uint32_t lo = std::min(a, b), hi = std::max(a, b);
      for (std::size_t o = old_row[lo]; o < old_row[lo + 1]; ++o) {
        if (old_j[o] != hi) continue;
        touching[e] = old_touching[o];
        if (!touching[e]) break;
        const bool turned = a > b;
        for (std::uint32_t k = 0; k < spec.columns; ++k) {
          const double v = old_history[o * columns + k];
          history[e * columns + k] = turned && spec.odd[k] ? -v : v;
        }
        break;
      }
    }
  }
}

void PairList::link_chunks() {
  std::vector<std::uint32_t> chunk_of(row_.size() - 1);
  for (std::uint32_t c = 0; c < chunks.size(); ++c) {
    chunks[c].incoming.clear();
    std::fill(chunk_of.begin() + chunks[c].first_sphere, chunk_of.begin() + chunks[c].last_sphere, c);
  }
  first_cross.assign(chunks.size() + 1, 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    std::size_t count = 0;
    for (std::size_t e = chunks[c].first_entry; e < chunks[c].last_entry; ++e) count += j[e] >= chunks[c].last_sphere;
    first_cross[c + 1] = first_cross[c] + count;
  }
  const std::size_t slots = first_cross.back();
  cross.resize(slots);
  slot_sphere.resize(slots);
  slot_wrench.resize(slots);
  slot_used.assign(slots, 0);
  std::vector<std::uint32_t> order, receiver;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    Chunk& chunk = chunks[c];
    chunk.first_slot = first_cross[c];
    chunk.last_slot = first_cross[c + 1];
    receiver.clear();
    for (std::size_t e = chunk.first_entry; e < chunk.last_entry; ++e)
      if (j[e] >= chunk.last_sphere) receiver.push_back(j[e]);
    order.resize(receiver.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return chunk_of[receiver[a]] < chunk_of[receiver[b]]; });
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      const std::size_t slot = chunk.first_slot + k;
      const std::uint32_t sphere = receiver[order[k]];
      cross[first_cross[c] + order[k]] = static_cast<std::uint32_t>(slot);
      slot_sphere[slot] = sphere;
      auto& in = chunks[chunk_of[sphere]].incoming;
      if (in.empty() || in.back().last != slot || in.back().first < chunk.first_slot) in.push_back({slot, slot});
      in.back().last = slot + 1;
    }
  }
}

std::size_t PairList::memory_bytes() const {
  std::size_t bytes = (i.capacity() + j.capacity() + cross.capacity() + slot_sphere.capacity()) * 4;
  bytes += touching.capacity() + slot_used.capacity() + history.capacity() * 8 + row_.capacity() * 8;
  bytes += slot_wrench.capacity() * sizeof(Wrench) + packed_.capacity() * sizeof(Binned);
  bytes += (cell_of_.capacity() + cell_start_.capacity() + binned_.capacity()) * 4;
  for (const auto& w : work_) bytes += (w.partner.capacity() + w.row_count.capacity() + 2 * w.extra.capacity()) * 4;
  return bytes;
}

}  // namespace calx
