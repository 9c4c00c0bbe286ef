// wall_list.cpp: search of parts near spheres, and carrying wall history over a rebuild.
#include "neighbour/wall_list.hpp"

#include <algorithm>

namespace calx {

namespace {

/// Consecutive spheres stand together: parts far from a group, then from a few, are skipped for all of them.
constexpr std::uint32_t kGroup = 64, kFew = 8;

/// Where a part can be touched, world frame.
Box world_box(const PartPlace& place) {
  const Box b = place.surface->bounds();
  Box world;
  for (int corner = 0; corner < 8; ++corner)
    world.add(place.shift + rotate(place.turn, {corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y,
                                                corner & 4 ? b.hi.z : b.lo.z}));
  return world;
}

bool apart(const Box& a, const Box& b, double reach) {
  return a.lo.x > b.hi.x + reach || a.lo.y > b.hi.y + reach || a.lo.z > b.hi.z + reach || a.hi.x < b.lo.x - reach ||
         a.hi.y < b.lo.y - reach || a.hi.z < b.lo.z - reach;
}

}  // namespace

/// What the search of a chunk reads.
struct WallList::Search {
  const Particles& particles;
  const std::vector<PartPlace>& parts;
  const Column<double>& margin;
  double margin_factor, gap;
  std::vector<Box> box;              // of each part, world frame
  std::vector<std::uint32_t> shown;  // parts that are present

  double reach(std::uint32_t k) const {
    return particles.spheres()[k].r + margin_factor * margin[particles.owner_of(k)] + gap;
  }
  /// Which of the parts some sphere of first .. last may touch.
  void near(std::uint32_t first, std::uint32_t last, const std::vector<std::uint32_t>& from,
            std::vector<std::uint32_t>& out, std::vector<std::uint32_t>& probe) const {
    out.clear();
    if (from.empty()) return;
    Box around;
    double farthest = 0;
    for (std::uint32_t k = first; k < last; ++k) {
      around.add(position(particles.spheres()[k]));
      farthest = std::max(farthest, reach(k));
    }
    // Rounding of the frames stays below a part in 1e9 of the lengths.
    const Vec3 middle = 0.5 * (around.lo + around.hi);
    const double radius = 0.5 * norm(around.hi - around.lo) * (1 + 1e-9);
    for (const std::uint32_t a : from) {
      const PartPlace& place = parts[a];
      const double most = (farthest + place.margin) * (1 + 1e-9);
      if (apart(around, box[a], most)) continue;
      probe.clear();
      place.surface->gather(rotate(conjugate(place.turn), middle - place.shift), radius + most, probe);
      if (!probe.empty()) out.push_back(a);
    }
  }
  void rows(std::uint32_t k, ChunkWork& w) const {
    const Record& s = particles.spheres()[k];
    for (const std::uint32_t a : w.near_few) {
      const PartPlace& place = parts[a];
      const auto first = static_cast<std::uint32_t>(w.elements.size());
      place.surface->gather(rotate(conjugate(place.turn), position(s) - place.shift), reach(k) + place.margin,
                            w.elements);
      if (w.elements.size() == first) continue;
      w.sphere.push_back(k);
      w.part.push_back(a);
      w.first_element.push_back(first);
    }
  }
  void chunk(std::uint32_t first, std::uint32_t last, ChunkWork& w) const {
    w.sphere.clear();
    w.part.clear();
    w.first_element.clear();
    w.elements.clear();
    for (; first < last; first += std::min(kGroup, last - first)) {
      const std::uint32_t group_end = std::min(last, first + kGroup);
      near(first, group_end, shown, w.near_group, w.probe);
      for (std::uint32_t f = first; f < group_end && !w.near_group.empty(); f += kFew) {
        const std::uint32_t few_end = std::min(group_end, f + kFew);
        near(f, few_end, w.near_group, w.near_few, w.probe);
        for (std::uint32_t k = f; k < few_end && !w.near_few.empty(); ++k) rows(k, w);
      }
    }
  }
};

void WallList::build(const Particles& p, const PairList& pairs, const std::vector<PartPlace>& parts,
                     const Column<double>& margin, double margin_factor, const HistorySpec& spec,
                     const std::uint32_t* old_rank, double gap) {
  const std::size_t chunk_count = pairs.chunks.size();
  work_.resize(std::max(work_.size(), chunk_count));
  Search search{p, parts, margin, margin_factor, gap, {}, {}};
  for (std::uint32_t a = 0; a < parts.size(); ++a) {
    search.box.push_back(world_box(parts[a]));
    if (parts[a].present) search.shown.push_back(a);
  }
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunk_count; ++c)
    search.chunk(pairs.chunks[c].first_sphere, pairs.chunks[c].last_sphere, work_[c]);

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
  std::vector<std::uint32_t> element_start(chunk_count + 1, 0);
  for (std::size_t c = 0; c < chunk_count; ++c) {
    first_row[c + 1] = first_row[c] + work_[c].sphere.size();
    element_start[c + 1] = element_start[c] + static_cast<std::uint32_t>(work_[c].elements.size());
  }
  const std::size_t rows = first_row.back();
  sphere.resize(rows);
  part.resize(rows);
  first_element.resize(rows + 1);
  first_element[rows] = element_start.back();
  elements.resize(element_start.back());
  row_of_sphere_.resize(p.sphere_count() + 1);
  row_of_sphere_.back() = static_cast<std::uint32_t>(rows);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < chunk_count; ++c) {
    const ChunkWork& w = work_[c];
    std::uint32_t next = pairs.chunks[c].first_sphere;
    for (std::size_t k = 0; k < w.sphere.size(); ++k) {
      const std::size_t row = first_row[c] + k;
      sphere[row] = w.sphere[k];
      part[row] = w.part[k];
      first_element[row] = element_start[c] + w.first_element[k];
      for (; next <= w.sphere[k]; ++next) row_of_sphere_[next] = static_cast<std::uint32_t>(row);
    }
    for (; next < pairs.chunks[c].last_sphere; ++next)
      row_of_sphere_[next] = static_cast<std::uint32_t>(first_row[c + 1]);
    std::copy(w.elements.begin(), w.elements.end(), elements.begin() + element_start[c]);
  }

  const std::size_t slots = rows * kWallContacts;
  touching.assign(slots, 0);
  normal.assign(slots, Vec3{});
  stride = stride_of(rows);
  history.resize(stride * spec.columns);
  if (old_row.empty()) return;
#pragma omp parallel for schedule(static)
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
