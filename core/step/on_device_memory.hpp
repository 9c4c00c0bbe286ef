// on_device_memory.hpp: what a device holds of a world. Private to step/on_device*.cpp.
#pragma once
#include <algorithm>

#include "step/on_device.hpp"

namespace calx {

constexpr std::size_t kPairValues = 9, kWallValues = 10, kEnergies = 4, kParticleEnergies = 9;  // see core/kernels

/// Flags of world.h.
enum DeviceFlag { flag_stale, flag_guard, flag_missing_law, flag_count };

inline std::uint32_t span_count(std::uint32_t length) { return (length + kSpan - 1) / kSpan; }

/// step_numbers of world.h.
struct Engine::OnDevice::Numbers {
  double dt, time;
  Vec3 gravity, low, high, length;
  std::uint32_t periodic[3];
  std::uint32_t spheres, particles, entries, wall_rows, chunks, parts, materials, columns, ledger, forces, spare;
};

/// Buffers and kernels.
struct Engine::OnDevice::Memory {
  explicit Memory(Device& d) : device(d) {}
  Device& device;
  DeviceModule module;
  DeviceKernel pair_contacts, wall_contacts, sum_contacts, move_spheres, move_clumps, drift_spheres, drift_clumps,
      particle_forces, kick_particles, fold_pairs, fold_walls, fold_particles, fold_chunks;
  // Of the case.
  DeviceBuffer law_of, law_numbers, force_numbers, shapes, triangles, edges, vertices, inwards, directions, axes,
      segments, points, alongs, parts;
  // Of the lists.
  DeviceBuffer body, member, turn, wrench, equal_radius, inertia, first_sphere, arms, sphere_material, margin, listed;
  DeviceBuffer pair_i, pair_j, pair_touching, pair_history, row_first, in_first, in_middle, in_entry;
  DeviceBuffer row_sphere, row_part, first_element, elements, wall_touching, wall_normals, wall_history, wall_first,
      wall_counts;
  DeviceBuffer chunks;
  // Of a step.
  DeviceBuffer added, pair_out, pair_share, pair_energy, wall_out, wall_share, wall_energy, sums, particle_energy,
      pair_sums, wall_sums, particle_sums, chunk_sums, flags;
  std::uint32_t sphere_spans = 0, particle_spans = 0;
  std::vector<double> results;  // of chunks, as they came back
  std::size_t bytes = 0;

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
};

}  // namespace calx
