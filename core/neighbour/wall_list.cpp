// wall_list.cpp: search of parts near spheres, and carrying wall history over a rebuild.
#include "neighbour/wall_list.hpp"

#include <algorithm>

namespace calx {

void WallList::build(const Particles& p, const PairList& pairs, const std::vector<PartPlace>& parts,
                     const Column<double>& margin, double margin_factor, const HistorySpec& spec,
                     const std::uint32_t* old_rank) {
  const Record* s = p.spheres();
  const std::size_t chunk_count = pairs.chunks.size();
  work_.resize(std::max(work_.size(), chunk_count));
  std::vector<Box> bounds(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) bounds[k] = parts[k].surface->bounds();

#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunk_count; ++c) {
    ChunkWork& w = work_[c];
    w.sphere.clear();
    w.part.clear();
    w.first_element.clear();
    w.elements.clear();
    for (std::uint32_t k = pairs.chunks[c].first_sphere; k < pairs.chunks[c].last_sphere; ++k) {
      for (std::uint32_t a = 0; a < parts.size(); ++a) {
        const PartPlace& place = parts[a];
        if (!place.present) continue;
        const double reach = s[k].r + margin_factor * margin[p.owner_of(k)] + place.margin;
        const Vec3 local = rotate(conjugate(place.turn), position(s[k]) - place.shift);
        const Box& b = bounds[a];
        if (local.x < b.lo.x - reach || local.y < b.lo.y - reach || local.z < b.lo.z - reach ||
            local.x > b.hi.x + reach || local.y > b.hi.y + reach || local.z > b.hi.z + reach)
          continue;
        const auto first = static_cast<std::uint32_t>(w.elements.size());
        place.surface->gather(local, reach, w.elements);
        if (w.elements.size() == first) continue;
        w.sphere.push_back(k);
        w.part.push_back(a);
        w.first_element.push_back(first);
      }
    }
  }

  const std::vector<std::uint32_t> old_row = std::move(row_of_sphere_);
  Column<std::uint32_t> old_part;
  old_part.swap(part);
  Column<std::uint8_t> old_touching;
  old_touching.swap(touching);
  Column<Vec3> old_normal;
  old_normal.swap(normal);
  Column<double> old_history;
  old_history.swap(history);
  const std::size_t old_stride = stride;

  first_row.assign(chunk_count + 1, 0);
  std::size_t element_total = 0;
  for (std::size_t c = 0; c < chunk_count; ++c) {
    first_row[c + 1] = first_row[c] + work_[c].sphere.size();
    element_total += work_[c].elements.size();
  }
  const std::size_t rows = first_row.back();
  sphere.resize(rows);
  part.resize(rows);
  first_element.resize(rows + 1);
  elements.clear();
  elements.reserve(element_total);
  row_of_sphere_.assign(p.sphere_count() + 1, 0);
  for (std::size_t c = 0; c < chunk_count; ++c) {
    const ChunkWork& w = work_[c];
    const auto base = static_cast<std::uint32_t>(elements.size());
    for (std::size_t k = 0; k < w.sphere.size(); ++k) {
      const std::size_t row = first_row[c] + k;
      sphere[row] = w.sphere[k];
      part[row] = w.part[k];
      first_element[row] = base + w.first_element[k];
      ++row_of_sphere_[w.sphere[k] + 1];
    }
    elements.insert(elements.end(), w.elements.begin(), w.elements.end());
  }
  first_element[rows] = static_cast<std::uint32_t>(elements.size());
  for (std::size_t k = 0; k < p.sphere_count(); ++k) row_of_sphere_[k + 1] += row_of_sphere_[k];

  const std::size_t slots = rows * kWallContacts;
  touching.assign(slots, 0);
  normal.assign(slots, Vec3{});
  stride = (slots + 7) / 8 * 8 + 8;
  history.resize(stride * spec.columns);
  if (old_row.empty()) return;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint32_t before = old_rank ? old_rank[sphere[row]] : sphere[row];
    if (before >= old_row.size() - 1) continue;
    for (std::uint32_t o = old_row[before]; o < old_row[before + 1]; ++o) {
      if (old_part[o] != part[row]) continue;
      for (std::uint32_t c = 0; c < kWallContacts; ++c) {
        const std::size_t to = row * kWallContacts + c, from = o * kWallContacts + c;
        touching[to] = old_touching[from];
        normal[to] = old_normal[from];
        if (!touching[to]) continue;
        for (std::uint32_t k = 0; k < spec.columns; ++k) history[k * stride + to] = old_history[k * old_stride + from];
      }
    }
  }
}

std::size_t WallList::memory_bytes() const {
  std::size_t bytes = (sphere.capacity() + part.capacity() + first_element.capacity() + elements.capacity()) * 4;
  bytes += touching.capacity() + normal.capacity() * sizeof(Vec3) + history.capacity() * 8;
  for (const auto& w : work_)
    bytes += (w.sphere.capacity() + w.part.capacity() + w.first_element.capacity() + w.elements.capacity()) * 4;
  return bytes + row_of_sphere_.capacity() * 4;
}

}  // namespace calx
