// on_device_lists.cpp: building the lists on a device: levels and cells, pairs, history carried over.
#include <cmath>

#include "neighbour/cell_levels.hpp"
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

// Layout of pairs.h.
struct DeviceLevel {
  double reach, inverse;  // m, 1/m
  std::uint32_t low[3], high[3], stride_y, stride_z, mask, start, folded, unused;
};
constexpr std::size_t kSeatBytes = 40, kChunkBytes = 24, kTouchBytes = 40;  // wall_touch of walls.h
static_assert(sizeof(DeviceLevel) == 64);

/// Cells are wider than the largest pair distance by this share; their coordinates count from so many cells before the
/// origin. See pairs.h.
constexpr double kSlack = 1e-6, kRange = 1e9;

std::uint32_t cell_at(double x, double origin, double inverse) {
  return static_cast<std::uint32_t>(std::min(std::max((x - origin) * inverse, -kRange), kRange) + kRange);
}

/// Strides and size of the table of a level of count spheres.
void lay_out(DeviceLevel& g, std::uint64_t count) {
  double extent[3], all = 1;
  for (int k = 0; k < 3; ++k) all *= extent[k] = double(g.high[k] - g.low[k]) + 1;
  const std::uint64_t most = std::max<std::uint64_t>(4096, 8 * count);
  std::uint64_t cells = 1;
  g.folded = all > static_cast<double>(most);
  while (static_cast<double>(cells) < (g.folded ? static_cast<double>(4 * count) : all)) cells *= 2;
  // Odd strides near the powers of the third root: neighbours seldom share a number.
  const double side = std::cbrt(static_cast<double>(cells));
  g.stride_y = g.folded ? static_cast<std::uint32_t>(side) | 1 : static_cast<std::uint32_t>(extent[0]);
  g.stride_z =
      g.folded ? static_cast<std::uint32_t>(side * side) | 1 : static_cast<std::uint32_t>(extent[0] * extent[1]);
  g.mask = static_cast<std::uint32_t>(cells - 1);
}

}  // namespace

/// Writes the levels; the number of cells of all. origin: of cell coordinates, m.
std::size_t Engine::OnDevice::make_levels(const Numbers& n, Vec3& origin) {
  Memory& m = *memory_;
  const DeviceBuffer& spheres = m.spheres(engine_.particles);
  for (DeviceBuffer& each : m.extents) m.reserve(each, runs_of(n.spheres) * sizeof(DeviceExtent));
  device_->launch(m.measure_spheres, runs_of(n.spheres),
                  arguments(n, n.spheres, spheres, m.owner, m.margin, m.extents[0]));
  DeviceExtent extent;
  device_->read(join_extents(runs_of(n.spheres)), &extent, sizeof extent);
  origin = 0.5 * (extent.low + extent.high);

  const ReachClasses classes(extent.smallest, extent.largest);
  const std::uint32_t class_count = classes.class_count();
  std::vector<double> bounds;
  for (std::uint32_t c = 0; c < class_count; ++c) bounds.push_back(classes.lower_bound(c));
  std::vector<std::uint32_t> counts(class_count, n.spheres);
  if (class_count > 1) {
    m.put(m.bounds, bounds);
    m.reserve(m.classes, class_count * sizeof(std::uint32_t));
    device_->zero(m.classes, class_count * sizeof(std::uint32_t));
    device_->launch(m.count_classes, n.spheres,
                    arguments(n, spheres, m.owner, m.margin, class_count, m.bounds, m.classes));
    m.take(m.classes, counts);
  }
  std::vector<ReachClasses::Class> found(class_count);
  for (std::uint32_t c = 0; c < class_count; ++c)
    found[c] = {counts[c], c + 1 < class_count ? bounds[c + 1] : extent.largest};
  std::vector<DeviceLevel> levels;
  std::size_t cells = 0;
  std::uint32_t c = 0;
  for (const double reach : choose_levels(found)) {
    DeviceLevel g{};
    g.reach = reach;
    g.inverse = 1 / (reach > 0 ? 2 * reach * (1 + kSlack) : 1);
    for (int k = 0; k < 3; ++k) {
      g.low[k] = cell_at(extent.low[k], origin[k], g.inverse);
      g.high[k] = cell_at(extent.high[k], origin[k], g.inverse);
    }
    std::uint64_t count = 0;
    for (; c < class_count && found[c].largest <= reach; ++c) count += found[c].count;
    lay_out(g, count);
    g.start = static_cast<std::uint32_t>(cells);
    cells += g.mask + std::size_t{1};
    levels.push_back(g);
  }
  m.put(m.levels, levels);
  level_count_ = static_cast<std::uint32_t>(levels.size());
  return cells;
}

void Engine::OnDevice::search_pairs(const Numbers& n) {
  Memory& m = *memory_;
  const std::size_t spheres = n.spheres, u32 = sizeof(std::uint32_t);
  const DeviceBuffer& all = m.spheres(engine_.particles);
  m.reserve(m.counts, (spheres + 1) * u32);
  std::swap(m.row_first, m.old_row_first);
  std::swap(m.pair_j, m.old_pair_j);
  m.reserve(m.row_first, (spheres + 1) * u32);
  entries_ = 0;
  if (spheres == 0) {
    device_->zero(m.row_first, u32);
    return;
  }
  Vec3 origin;
  const std::size_t cells = make_levels(n, origin);
  m.reserve(m.cell_of, spheres * u32);
  m.reserve(m.level_of, spheres * u32);
  m.reserve(m.cell_counts, cells * u32);
  m.reserve(m.cell_start, (cells + 1) * u32);
  m.reserve(m.seats, spheres * kSeatBytes);
  device_->zero(m.cell_counts, cells * u32);
  device_->launch(m.count_cells, spheres,
                  arguments(n, origin, all, m.owner, m.margin, m.levels, m.cell_counts, m.cell_of, m.level_of));
  device_->exclusive_scan(m.cell_counts, m.cell_start, cells);
  device_->launch(m.fill_cells, spheres,
                  arguments(n, all, m.owner, m.margin, m.cell_of, m.cell_start, m.cell_counts, m.seats));
  const auto search = [&](const DeviceBuffer& rows, const DeviceBuffer& partners) {
    device_->zero(m.counts, spheres * u32);
    device_->launch(m.search_pairs, spheres,
                    arguments(n, origin, all, m.owner, m.margin, level_count_, m.levels, m.level_of, m.cell_start,
                              m.seats, m.counts, rows, partners));
  };
  const DeviceBuffer none;
  search(none, none);
  device_->exclusive_scan(m.counts, m.row_first, spheres);
  entries_ = m.number_at(m.row_first, spheres);
  m.reserve(m.pair_j, entries_ * u32);
  search(m.row_first, m.pair_j);
}

/// From row_first and pair_j: i of each entry, and the entries of which each sphere is the second.
void Engine::OnDevice::link_entries(const Numbers& n) {
  Memory& m = *memory_;
  const std::size_t spheres = n.spheres, u32 = sizeof(std::uint32_t);
  m.reserve(m.counts, (spheres + 1) * u32);
  m.reserve(m.pair_i, entries_ * u32);
  m.reserve(m.in_first, (spheres + 1) * u32);
  m.reserve(m.in_middle, spheres * u32);
  m.reserve(m.in_entry, entries_ * u32);
  device_->zero(m.counts, spheres * u32);
  device_->launch(m.sort_pairs, spheres, arguments(n.spheres, m.row_first, m.pair_i, m.pair_j, m.counts));
  device_->exclusive_scan(m.counts, m.in_first, spheres);
  device_->launch(m.note_incoming, entries_, arguments(n.entries, m.pair_j, m.in_first, m.counts, m.in_entry));
  device_->launch(m.sort_incoming, spheres,
                  arguments(n.spheres, chunk_length(n.particles), m.owner, m.first_sphere, m.pair_i, m.in_first,
                            m.in_middle, m.in_entry));
}

void Engine::OnDevice::make_chunks(const Numbers& n) {
  Memory& m = *memory_;
  m.reserve(m.chunks, n.chunks * kChunkBytes);
  m.reserve(m.spans, 2 * sizeof(std::uint32_t));
  device_->launch(
      m.make_chunks, 1,
      arguments(n.particles, chunk_length(n.particles), n.chunks,
                static_cast<std::uint32_t>(engine_.particles.has_clumps), m.first_sphere, m.chunks, m.spans));
  std::uint32_t spans[2];
  device_->read(m.spans, spans, sizeof spans);
  m.particle_spans = spans[0];
  m.sphere_spans = spans[1];
}

/// Work space of steps with the lists as they are.
void Engine::OnDevice::size_step() {
  Memory& m = *memory_;
  const Particles& p = engine_.particles;
  const EngineOptions& o = engine_.options;
  const std::size_t width = result_width(), slots = rows_ * kWallContacts;
  m.reserve(m.pair_out, kPairValues * entries_ * (o.mixed ? sizeof(float) : sizeof(double)));
  m.reserve(m.pair_share, entries_ * sizeof(double));
  if (o.ledger) m.reserve(m.pair_energy, kEnergies * entries_ * sizeof(double));
  m.reserve(m.wall_counts, rows_ * sizeof(std::uint32_t));
  m.reserve(m.wall_touches, slots * kTouchBytes);
  m.reserve(m.wall_out, kWallValues * slots * sizeof(double));
  m.reserve(m.wall_share, slots * sizeof(double));
  if (o.ledger) m.reserve(m.wall_energy, kEnergies * slots * sizeof(double));
  m.reserve(m.sums, p.sphere_count() * sizeof(Wrench));
  if (!engine_.forces.empty()) m.reserve(m.added, p.count() * sizeof(Wrench));
  if (o.ledger || o.verlet || !engine_.forces.empty())
    m.reserve(m.particle_energy, kParticleEnergies * p.count() * sizeof(double));
  m.reserve(m.pair_sums, m.sphere_spans * kSums * sizeof(double));
  m.reserve(m.wall_sums, m.sphere_spans * width * sizeof(double));
  m.reserve(m.particle_sums, m.particle_spans * kParticleEnergies * sizeof(double));
  m.reserve(m.chunk_sums, (p.count() / chunk_length(p.count()) + 1) * width * sizeof(double));
  m.forget_graphs();
}

void Engine::OnDevice::build_lists(double dt, bool reorder) {
  send();
  send_gaps();
  Memory& m = *memory_;
  Numbers n = numbers(dt);
  m.forget_graphs();
  m.reserve(m.margin, n.particles * sizeof(double));
  m.reserve(m.listed, n.spheres * sizeof(Vec3));
  if (n.periodic[0] || n.periodic[1] || n.periodic[2]) wrap(n);
  if (reorder && n.particles > 0) sort_particles(n);
  device_->launch(
      m.set_margins, n.particles,
      arguments(n.particles, kListSteps * dt, engine_.smallest_margin_, engine_.largest_margin_, m.body, m.margin));
  search_pairs(n);
  n = numbers(dt);
  link_entries(n);
  std::swap(m.pair_touching, m.old_pair_touching);
  std::swap(m.pair_history, m.old_pair_history);
  m.reserve(m.pair_touching, entries_);
  m.reserve(m.pair_history, entries_ * n.columns * sizeof(double));
  device_->launch(
      m.carry_pairs, entries_,
      arguments(n, listed_spheres_, m.list_rank, m.sphere_material, m.odd, m.old_row_first, m.old_pair_j,
                m.old_pair_touching, m.old_pair_history, m.pair_i, m.pair_j, m.pair_touching, m.pair_history));
  make_chunks(n);
  build_walls(1);
  device_->launch(m.keep_places, n.spheres, arguments(n.spheres, m.spheres(engine_.particles), m.listed, m.list_rank));
  listed_spheres_ = n.spheres;
}

}  // namespace calx
