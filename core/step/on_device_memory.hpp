// on_device_memory.hpp: what a device holds of a world. Private to step/on_device*.cpp.
#pragma once
#include <algorithm>

#include "step/on_device.hpp"

namespace calx {

constexpr std::size_t kPairValues = 9, kWallValues = 10, kEnergies = 4, kParticleEnergies = 9;  // see core/kernels

/// Flags of world.h.
enum DeviceFlag {
  flag_stale,
  flag_guard,
  flag_missing_law,
  flag_overlap,
  flag_done,
  flag_drifted,
  flag_stop,
  flag_count
};

/// extent of order.h.
struct DeviceExtent {
  Vec3 low, high;            // m
  double smallest, largest;  // reach, m
};
static_assert(sizeof(DeviceExtent) == 64);
/// Runs of EXTENT_RUN or WRAP_SPAN of order.h.
inline std::size_t runs_of(std::size_t n) { return (n + 63) / 64; }

/// step_numbers of world.h.
struct Engine::OnDevice::Numbers {
  double dt, overlap_limit;
  Vec3 gravity, low, high, length;
  double half_pair_gap, wall_gap;
  std::uint32_t periodic[3];
  std::uint32_t spheres, particles, entries, wall_rows, chunks, parts, materials, columns, ledger, forces, part_stride;
};

/// Buffers and kernels.
struct Engine::OnDevice::Memory {
  explicit Memory(Device& d) : device(d) {}
  Device& device;
  DeviceModule module, list_module;
  // Of a step.
  DeviceKernel pair_contacts, find_wall_contacts, wall_contacts, sum_contacts, move_spheres, move_clumps, drift_spheres,
      drift_clumps, particle_forces, kick_particles, fold_pairs, fold_walls, fold_particles, fold_chunks, fold_drift,
      close_sums, close_step, close_drift, make_chunks;
  // Of lists.
  DeviceKernel wrap_particles, add_wrapped, measure_spheres, measure_particles, join_extents, morton_keys, count_digits,
      move_by_digit, take_rows, count_members, order_members, set_margins, keep_places, count_classes, count_cells,
      fill_cells, search_pairs, sort_pairs, note_incoming, sort_incoming, carry_pairs, search_parts, carry_rows;

  // Of the case.
  DeviceBuffer law_of, law_numbers, gaps, force_numbers, odd, shapes, triangles, edges, vertices, inwards, directions,
      axes, segments, points, alongs, trees, nodes, tree_elements;
  // Of particles and their spheres. host_rank: rank of each particle in the host's columns.
  DeviceBuffer body, member, turn, wrench, equal_radius, inertia, first_sphere, owner, arms, sphere_material, margin,
      listed, list_rank, host_rank;
  // Of lists. old_: of the lists before, while history is carried over.
  DeviceBuffer row_first, pair_i, pair_j, pair_touching, pair_history, in_first, in_middle, in_entry;
  DeviceBuffer old_row_first, old_pair_j, old_pair_touching, old_pair_history;
  DeviceBuffer wall_first, row_sphere, row_part, first_element, elements, wall_touching, wall_normals, wall_history;
  DeviceBuffer old_wall_first, old_row_part, old_wall_touching, old_wall_normals, old_wall_history;
  DeviceBuffer chunks, spans;
  // While lists are built.
  DeviceBuffer extents[2], keys[2], order[2], used, counts, more_counts, digit_counts, spare, sphere_order, classes,
      bounds, levels, cell_of, level_of, cell_counts, cell_start, seats, element_first, places;
  // Of a step.
  DeviceBuffer parts, times, added, pair_out, pair_share, pair_energy, wall_counts, wall_touches, wall_out, wall_share,
      wall_energy, sums, particle_energy, pair_sums, wall_sums, particle_sums, chunk_sums, totals, flags;
  std::uint32_t sphere_spans = 0, particle_spans = 0;
  DeviceGraph first_half, second_half;  // of a step: what verlet does before the contacts; all else
  double recorded_dt = -1;              // s; of the graphs
  std::size_t bytes = 0;

  void forget_graphs() {
    first_half = second_half = {};
    recorded_dt = -1;
  }
  /// At least so many bytes; what was there is gone when it grows.
  void reserve(DeviceBuffer& buffer, std::size_t size) {
    if (buffer && buffer.bytes() >= size) return;
    bytes -= buffer.bytes();
    buffer = {};
    // Room to grow, so that a filling world does not allocate at every list.
    buffer = device.allocate(std::max<std::size_t>(64, size + size / 4));
    bytes += buffer.bytes();
  }
  template <class Values>
  void put(DeviceBuffer& buffer, const Values& values) {
    const std::size_t size = values.size() * sizeof(values[0]);
    reserve(buffer, size);
    if (size > 0) device.write(buffer, values.data(), size);
  }
  template <class Values>
  void take(const DeviceBuffer& buffer, Values& values) {
    if (!values.empty()) device.read(buffer, values.data(), values.size() * sizeof(values[0]));
  }
  /// A u32 of a buffer.
  std::uint32_t number_at(const DeviceBuffer& buffer, std::size_t k) {
    std::uint32_t value = 0;
    device.read(buffer, &value, sizeof value, k * sizeof value);
    return value;
  }
  const DeviceBuffer& spheres(const Particles& p) const { return p.has_clumps ? member : body; }
};

}  // namespace calx
