// on_device_step.cpp: the kernels of a step, recorded once for each build of the lists and started as one.
#include "step/on_device_memory.hpp"

namespace calx {

void Engine::OnDevice::launch_drift(const Numbers& n) {
  Memory& m = *memory_;
  if (engine_.particles.has_clumps)
    device_->launch(m.drift_clumps, n.particles,
                    arguments(n, m.body, m.member, m.turn, m.inertia, m.first_sphere, m.arms, m.wrench, m.listed,
                              m.margin, m.particle_energy, m.flags));
  else
    device_->launch(m.drift_spheres, n.particles,
                    arguments(n, m.body, m.wrench, m.listed, m.margin, m.particle_energy, m.flags));
  device_->launch(m.fold_particles, m.particle_spans,
                  arguments(n, m.particle_spans, m.chunks, m.particle_energy, m.particle_sums, m.flags));
  device_->launch(m.fold_drift, n.chunks,
                  arguments(n, m.particle_spans, m.chunks, m.particle_sums, m.chunk_sums, m.flags));
  device_->launch(m.close_drift, 1, arguments(n, m.chunk_sums, m.totals, m.flags));
}

void Engine::OnDevice::launch_integration(const Numbers& n) {
  Memory& m = *memory_;
  const bool clumps = engine_.particles.has_clumps;
  if (engine_.options.verlet)
    device_->launch(
        m.kick_particles, n.particles,
        arguments(n, static_cast<std::uint32_t>(clumps), m.body, m.member, m.turn, m.inertia, m.first_sphere, m.arms,
                  m.sums, m.added, m.wrench, m.listed, m.margin, m.particle_energy, m.flags));
  else if (clumps)
    device_->launch(m.move_clumps, n.particles,
                    arguments(n, m.body, m.member, m.turn, m.inertia, m.first_sphere, m.arms, m.sums, m.added, m.listed,
                              m.margin, m.particle_energy, m.flags));
  else
    device_->launch(m.move_spheres, n.particles,
                    arguments(n, m.body, m.sums, m.added, m.listed, m.margin, m.particle_energy, m.flags));
}

void Engine::OnDevice::launch_rest_of_step(const Numbers& n) {
  Memory& m = *memory_;
  Device& d = *device_;
  const bool clumps = engine_.particles.has_clumps;
  const DeviceBuffer& spheres = m.spheres(engine_.particles);
  const std::uint64_t stride = wall_stride_;
  d.launch(m.pair_contacts, n.entries,
           arguments(n, spheres, m.sphere_material, m.pair_i, m.pair_j, m.pair_touching, m.pair_history, m.law_of,
                     m.law_numbers, m.gaps, m.times, m.pair_out, m.pair_share, m.pair_energy, m.flags));
  d.launch(m.find_wall_contacts, n.wall_rows,
           arguments(n, spheres, m.sphere_material, m.row_sphere, m.row_part, m.first_element, m.elements, m.parts,
                     m.gaps, m.shapes, m.triangles, m.edges, m.vertices, m.inwards, m.directions, m.axes, m.segments,
                     m.points, m.alongs, m.wall_touching, m.wall_normals, m.wall_counts, m.wall_touches, m.flags));
  d.launch(m.wall_contacts, n.wall_rows * kWallContacts,
           arguments(n, spheres, m.sphere_material, m.row_sphere, m.row_part, m.parts, m.wall_counts, m.wall_touches,
                     m.wall_history, stride, m.law_of, m.law_numbers, m.times, m.wall_out, m.wall_share, m.wall_energy,
                     m.flags));
  d.launch(m.sum_contacts, n.spheres,
           arguments(n, m.row_first, m.in_first, m.in_middle, m.in_entry, m.pair_touching, m.pair_out, m.wall_first,
                     m.wall_counts, m.wall_out, m.sums, m.flags));
  if (n.forces)
    d.launch(m.particle_forces, n.particles,
             arguments(n, m.body, m.equal_radius, m.force_numbers, m.times, m.added, m.flags));
  launch_integration(n);
  d.launch(m.fold_pairs, m.sphere_spans,
           arguments(n, m.sphere_spans, m.chunks, m.pair_i, m.pair_j, m.row_first, m.pair_touching, m.pair_share,
                     m.pair_energy, m.pair_sums, m.flags));
  d.launch(m.fold_walls, m.sphere_spans,
           arguments(n, m.sphere_spans, m.chunks, m.wall_first, m.row_sphere, m.row_part, m.wall_counts, m.wall_out,
                     m.wall_share, m.wall_energy, m.wall_sums, m.flags));
  if (n.ledger || n.forces)
    d.launch(m.fold_particles, m.particle_spans,
             arguments(n, m.particle_spans, m.chunks, m.particle_energy, m.particle_sums, m.flags));
  const std::uint32_t halves = clumps && !engine_.options.verlet;
  d.launch(m.fold_chunks, n.chunks,
           arguments(n, halves, m.sphere_spans, m.particle_spans, m.chunks, m.pair_sums, m.wall_sums, m.particle_sums,
                     m.chunk_sums, m.flags));
  d.launch(m.close_sums, result_width(), arguments(n, m.chunk_sums, m.totals, m.flags));
  d.launch(m.close_step, 1, arguments(m.flags));
}

void Engine::OnDevice::record(double dt) {
  Memory& m = *memory_;
  const bool moving =
      std::any_of(engine_.parts.begin(), engine_.parts.end(), [](const EnginePart& p) { return p.moves; });
  if (m.recorded_dt == dt && moving == moving_) return;
  m.forget_graphs();
  moving_ = moving;
  const Numbers n = numbers(dt);
  if (engine_.options.verlet) {
    device_->begin_capture();
    launch_drift(n);
    m.first_half = device_->end_capture();
  }
  device_->begin_capture();
  launch_rest_of_step(n);
  m.second_half = device_->end_capture();
  m.recorded_dt = dt;
}

Engine::OnDevice::Outcome Engine::OnDevice::take_flags() {
  std::uint32_t flags[flag_count];
  device_->read(memory_->flags, flags, sizeof flags);
  fetched_ = lists_fetched_ = sums_fetched_ = false;
  Outcome out;
  out.done = flags[flag_done];
  out.drifted = flags[flag_drifted] != 0;
  out.stale = flags[flag_stale] != 0;
  out.spoken = flags[flag_guard] != 0 || flags[flag_overlap] != 0;
  out.missing_law = flags[flag_missing_law];
  return out;
}

Engine::OnDevice::Outcome Engine::OnDevice::run(const StepTable& table, std::size_t first, std::size_t count,
                                                bool drifted, double dt) {
  send();
  record(dt);
  send_table(table, first, count);
  device_->zero(memory_->flags, flag_count * sizeof(std::uint32_t));
  for (std::size_t k = 0; k < count; ++k) {
    if (engine_.options.verlet && !(drifted && k == 0)) device_->launch(memory_->first_half);
    device_->launch(memory_->second_half);
  }
  return take_flags();
}

Engine::OnDevice::Outcome Engine::OnDevice::drift(double dt) {
  send();
  record(dt);
  device_->zero(memory_->flags, flag_count * sizeof(std::uint32_t));
  device_->launch(memory_->first_half);
  return take_flags();
}

}  // namespace calx
