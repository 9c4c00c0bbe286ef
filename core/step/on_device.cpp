// on_device.cpp: the kernels of a step, and what comes back.
#include "step/on_device.hpp"

#include "base/error.hpp"
#include "compute/law_text.hpp"
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

/// Sums of fold.h.
enum Sum {
  sum_elastic,
  sum_friction,
  sum_damping,
  sum_plastic,
  sum_touching,
  sum_largest,
  sum_largest_i,
  sum_largest_j,
  sum_wall_work,
  sum_translation,
  sum_rotation,
  sum_gravity,
  sum_gravity_work,
  sum_force_work
};
std::uint32_t as_index(double number) { return static_cast<std::uint32_t>(number); }

}  // namespace

Engine::OnDevice::OnDevice(std::unique_ptr<Device> device, Engine& engine, bool fast)
    : device_(std::move(device)), engine_(engine), memory_(std::make_unique<Memory>(*device_)) {
  build(fast);
  send_shapes();
}

Engine::OnDevice::~OnDevice() = default;

void Engine::OnDevice::build(bool fast) {
  Memory& m = *memory_;
  const LawProgram contact_text = law_program(engine_.laws);
  ModuleText text;
  text.label = "step";
  text.fast = fast;
  const bool mixed = engine_.options.mixed;
  text.add("world.h");
  if (mixed) {
    text.add_laws(32, contact_text.laws);
    text.add("laws of the case", contact_text.text);
    text.add("contacts.h");
  }
  text.add_laws(64, contact_text.laws);
  text.add("laws of the case", contact_text.text);
  const ForceProgram force_text = force_program(engine_.forces);
  for (const TextPart& force : force_text.forces) text.add(force.name, force.text);
  text.add("forces of the case", force_text.text);
  for (const char* part : {"contacts.h", "surfaces.h", "walls.h", "forces.h", "motion.h", "fold.h"}) text.add(part);
  m.module = device_->build(text);
  m.pair_contacts = m.module.kernel(mixed ? "pair_contacts_f32" : "pair_contacts_f64");
  m.wall_contacts = m.module.kernel("wall_contacts");
  m.sum_contacts = m.module.kernel(mixed ? "sum_contacts_mixed" : "sum_contacts");
  m.move_spheres = m.module.kernel("move_spheres");
  m.move_clumps = m.module.kernel("move_clumps");
  m.particle_forces = m.module.kernel("particle_forces");
  m.drift_spheres = m.module.kernel("drift_spheres");
  m.drift_clumps = m.module.kernel("drift_clumps");
  m.kick_particles = m.module.kernel("kick_particles");
  m.fold_pairs = m.module.kernel("fold_pairs");
  m.fold_walls = m.module.kernel("fold_walls");
  m.fold_particles = m.module.kernel("fold_particles");
  m.fold_chunks = m.module.kernel("fold_chunks");
  m.put(m.law_of, contact_text.law_of);
  m.put(m.law_numbers, contact_text.numbers);
  m.put(m.force_numbers, force_text.numbers);
  m.reserve(m.flags, flag_count * sizeof(std::uint32_t));
}

Engine::OnDevice::Numbers Engine::OnDevice::numbers(double t, double dt) const {
  const EngineOptions& o = engine_.options;
  Numbers n{};
  n.dt = dt;
  n.time = t;
  n.gravity = o.gravity;
  n.low = o.domain.lo;
  n.high = o.domain.hi;
  n.length = o.wrap.length;
  for (std::size_t k = 0; k < 3; ++k) n.periodic[k] = o.wrap.periodic[k];
  n.spheres = static_cast<std::uint32_t>(engine_.particles.sphere_count());
  n.particles = static_cast<std::uint32_t>(engine_.particles.count());
  n.entries = static_cast<std::uint32_t>(engine_.pairs_.entry_count());
  n.wall_rows = static_cast<std::uint32_t>(engine_.walls_.row_count());
  n.chunks = static_cast<std::uint32_t>(engine_.pairs_.chunks.size());
  n.parts = static_cast<std::uint32_t>(engine_.parts.size());
  n.materials = engine_.material_count;
  n.columns = engine_.history_.columns;
  n.ledger = o.ledger;
  n.forces = !engine_.forces.empty();
  return n;
}

void Engine::OnDevice::drift(double dt) {
  Memory& m = *memory_;
  send_lists();
  const Numbers n = numbers(0, dt);
  if (n.particles == 0) return;
  fetched_ = false;
  device_->zero(m.flags, flag_count * sizeof(std::uint32_t));
  if (engine_.particles.has_clumps)
    device_->launch(m.drift_clumps, n.particles,
                    arguments(n, m.body, m.member, m.turn, m.inertia, m.first_sphere, m.arms, m.wrench, m.listed,
                              m.margin, m.particle_energy, m.flags));
  else
    device_->launch(m.drift_spheres, n.particles,
                    arguments(n, m.body, m.wrench, m.listed, m.margin, m.particle_energy, m.flags));
  device_->launch(m.fold_particles, m.particle_spans,
                  arguments(n, m.particle_spans, m.chunks, m.particle_energy, m.particle_sums));
  std::uint32_t flags[flag_count];
  device_->read(m.flags, flags, sizeof flags);
  std::vector<double> sums(m.particle_spans * kParticleEnergies);
  m.take(m.particle_sums, sums);
  std::size_t span = 0;
  for (std::size_t c = 0; c < engine_.results_.size(); ++c) {
    const Chunk& k = engine_.pairs_.chunks[c];
    const std::size_t end = span + span_count(k.last_particle - k.first_particle);
    for (; span < end; ++span) engine_.results_[c].gravity_work.total += sums[span * kParticleEnergies];
  }
  engine_.results_.front().stale = flags[flag_stale] != 0;
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

void Engine::OnDevice::step(double t, double dt) {
  Memory& m = *memory_;
  Device& d = *device_;
  send_lists();
  send_parts();
  const Numbers n = numbers(t, dt);
  const bool clumps = engine_.particles.has_clumps;
  const DeviceBuffer& spheres = clumps ? m.member : m.body;
  const std::uint64_t stride = engine_.walls_.stride;
  fetched_ = false;
  d.zero(m.flags, flag_count * sizeof(std::uint32_t));
  if (n.entries > 0)
    d.launch(m.pair_contacts, n.entries,
             arguments(n, spheres, m.sphere_material, m.pair_i, m.pair_j, m.pair_touching, m.pair_history, m.law_of,
                       m.law_numbers, m.pair_out, m.pair_share, m.pair_energy, m.flags));
  if (n.wall_rows > 0)
    d.launch(m.wall_contacts, n.wall_rows,
             arguments(n, spheres, m.sphere_material, m.row_sphere, m.row_part, m.first_element, m.elements, m.parts,
                       m.shapes, m.triangles, m.edges, m.vertices, m.inwards, m.directions, m.axes, m.segments,
                       m.points, m.alongs, m.wall_touching, m.wall_normals, m.wall_history, stride, m.law_of,
                       m.law_numbers, m.wall_counts, m.wall_out, m.wall_share, m.wall_energy, m.flags));
  if (n.spheres > 0)
    d.launch(m.sum_contacts, n.spheres,
             arguments(n, m.row_first, m.in_first, m.in_middle, m.in_entry, m.pair_touching, m.pair_out, m.wall_first,
                       m.wall_counts, m.wall_out, m.sums));
  if (n.particles > 0 && n.forces)
    d.launch(m.particle_forces, n.particles, arguments(n, m.body, m.equal_radius, m.force_numbers, m.added));
  if (n.particles > 0) launch_integration(n);
  if (m.sphere_spans > 0) {
    d.launch(m.fold_pairs, m.sphere_spans,
             arguments(n, m.sphere_spans, m.chunks, m.pair_i, m.pair_j, m.row_first, m.pair_touching, m.pair_share,
                       m.pair_energy, m.pair_sums));
    d.launch(m.fold_walls, m.sphere_spans,
             arguments(n, m.sphere_spans, m.chunks, m.wall_first, m.row_sphere, m.row_part, m.wall_counts, m.wall_out,
                       m.wall_share, m.wall_energy, m.wall_sums));
  }
  if ((n.ledger || n.forces) && m.particle_spans > 0)
    d.launch(m.fold_particles, m.particle_spans,
             arguments(n, m.particle_spans, m.chunks, m.particle_energy, m.particle_sums));
  const std::uint32_t halves = clumps && !engine_.options.verlet;
  if (n.chunks > 0)
    d.launch(m.fold_chunks, n.chunks,
             arguments(n, halves, m.sphere_spans, m.particle_spans, m.chunks, m.pair_sums, m.wall_sums, m.particle_sums,
                       m.chunk_sums));
  take_results();
}

void Engine::OnDevice::take_results() {
  Memory& m = *memory_;
  std::uint32_t flags[flag_count];
  device_->read(m.flags, flags, sizeof flags);
  if (flags[flag_missing_law] != 0) {
    const std::uint32_t pair = flags[flag_missing_law] - 1;
    engine_.missing_law(pair / engine_.material_count, pair % engine_.material_count);
  }
  const std::size_t width = result_width();
  m.results.resize(engine_.results_.size() * width);
  m.take(m.chunk_sums, m.results);
  for (std::size_t c = 0; c < engine_.results_.size(); ++c) {
    const double* from = &m.results[c * width];
    ChunkResult& r = engine_.results_[c];
    r.energy.total = {from[sum_elastic], from[sum_friction], from[sum_damping], from[sum_plastic]};
    r.wall_work.total = from[sum_wall_work];
    r.touching = static_cast<std::uint64_t>(from[sum_touching]);
    r.largest_overlap = from[sum_largest];
    r.overlap_i = as_index(from[sum_largest_i]);
    r.overlap_j = as_index(from[sum_largest_j]);
    r.kinetic_translation.total = from[sum_translation];
    r.kinetic_rotation.total = from[sum_rotation];
    r.gravity.total = from[sum_gravity];
    r.gravity_work.total = from[sum_gravity_work];
    r.force_work.total = from[sum_force_work];
    r.load.resize(engine_.parts.size());
    for (std::size_t k = 0; k < r.load.size(); ++k) {
      const double* w = from + kSums + 6 * k;
      r.load[k] = {w[0], w[1], w[2], w[3], w[4], w[5]};
    }
  }
  if (flags[flag_stale] != 0) engine_.results_.front().stale = true;
  if (flags[flag_guard] == 0) return;
  fetch();
  for (std::size_t c = 0; c < engine_.results_.size(); ++c) engine_.guard_each(c);
}

void Engine::OnDevice::fetch() {
  if (fetched_) return;
  fetched_ = true;
  Memory& m = *memory_;
  Particles& p = engine_.particles;
  m.take(m.body, p.body);
  if (p.has_clumps) {
    m.take(m.member, p.member);
    m.take(m.turn, p.turn);
  }
  if (engine_.options.verlet) m.take(m.wrench, p.wrench);
  m.take(m.pair_touching, engine_.pairs_.touching);
  m.take(m.pair_history, engine_.pairs_.history);
  m.take(m.wall_touching, engine_.walls_.touching);
  m.take(m.wall_normals, engine_.walls_.normal);
  m.take(m.wall_history, engine_.walls_.history);
}

std::size_t Engine::OnDevice::memory_bytes() const { return memory_->bytes; }

}  // namespace calx
