// pair_list.cpp: cell lists, pair search and carrying history from the old list to the new.
#include "neighbour/pair_list.hpp"

#include <algorithm>
#include <cmath>

namespace calx {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

}  // namespace

/// Particles per chunk: many, so that little crosses; about 32 chunks, so that 8 threads share well.
std::uint32_t chunk_length(std::size_t particle_count) {
  const std::size_t even = (particle_count + 31) / 32;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(even, 256, 4096));
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
  run_start_.clear();
  for (const Chunk& k : chunks) run_start_.push_back(k.first_sphere);
  run_start_.push_back(static_cast<std::uint32_t>(p.sphere_count()));
}

void PairList::build(const Particles& p, const Wrap& wrap, const Column<double>& margin, const HistorySpec& spec,
                     const std::uint32_t* old_rank, double gap) {
  const std::size_t n = p.sphere_count();
  make_chunks(p);
  search_.find(p, wrap, margin, run_start_, gap);

  Column<std::size_t> old_row;
  old_row.swap(row_);
  Column<std::uint32_t> old_j;
  old_j.swap(j);
  Column<std::uint8_t> old_touching;
  old_touching.swap(touching);
  Column<double> old_history;
  old_history.swap(history);

  std::size_t entries = 0;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    chunks[c].first_entry = entries;
    chunks[c].last_entry = entries += search_.run(c).partner.size();
  }
  row_.resize(n + 1);
  row_[n] = entries;
  i.resize(entries);
  j.resize(entries);
  touching.assign(entries, 0);
  columns = spec.columns;
  history.resize(entries * columns + 4);  // rows are read four values at a time

#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const CellSearch::Run& found = search_.run(c);
    std::size_t e = chunks[c].first_entry;
    std::copy(found.partner.begin(), found.partner.end(), j.begin() + static_cast<std::ptrdiff_t>(e));
    std::uint32_t k = chunks[c].first_sphere;
    for (const std::uint32_t count : found.count) {
      row_[k] = e;
      for (std::uint32_t m = 0; m < count; ++m) i[e++] = k;
      ++k;
    }
  }
  if (!old_row.empty()) carry_history(p, spec, old_rank, old_row, old_j, old_touching, old_history);
  link_chunks();
}

void PairList::carry_history(const Particles& particles, const HistorySpec& spec, const std::uint32_t* old_rank,
                             const Column<std::size_t>& old_row, const Column<std::uint32_t>& old_j,
                             const Column<std::uint8_t>& old_touching, const Column<double>& old_history) {
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
        const double* from = &old_history[o * columns];
        double* to = &history[e * columns];
        std::copy(from, from + columns, to);
        if (a < b) break;
        std::size_t pair = 0;
        if (spec.materials > 1)
          pair = static_cast<std::size_t>(particles.material[particles.owner_of(i[e])]) * spec.materials +
                 particles.material[particles.owner_of(j[e])];
        const std::uint8_t* odd = &spec.odd[pair * columns];
        for (std::uint32_t k = 0; k < columns; ++k)
          if (odd[k]) to[k] = -to[k];
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
  bytes += slot_wrench.capacity() * sizeof(Wrench) + run_start_.capacity() * 4 + search_.memory_bytes();
  return bytes;
}

}  // namespace calx
