// on_device.cpp: the modules of a device, and what the host takes when it looks.
#include "step/on_device.hpp"

#include <numeric>

#include "base/error.hpp"
#include "compute/law_text.hpp"
#include "step/on_device_memory.hpp"
#include "step/on_device_text.hpp"

namespace calx {
namespace {

/// Totals of fold.h.
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
  const ForceProgram force_text = force_program(engine_.forces);
  m.module = device_->build(step_text(contact_text, force_text, engine_.options.mixed, fast));
  m.list_module = device_->build(list_text());
  const bool mixed = engine_.options.mixed;
  m.pair_contacts = m.module.kernel(mixed ? "pair_contacts_f32" : "pair_contacts_f64");
  m.sum_contacts = m.module.kernel(mixed ? "sum_contacts_mixed" : "sum_contacts");
#define CALX_KERNEL_OF(of, name) m.name = m.of.kernel(#name)
  CALX_KERNEL_OF(module, find_wall_contacts);
  CALX_KERNEL_OF(module, wall_contacts);
  CALX_KERNEL_OF(module, move_spheres);
  CALX_KERNEL_OF(module, move_clumps);
  CALX_KERNEL_OF(module, particle_forces);
  CALX_KERNEL_OF(module, drift_spheres);
  CALX_KERNEL_OF(module, drift_clumps);
  CALX_KERNEL_OF(module, kick_particles);
  CALX_KERNEL_OF(module, fold_pairs);
  CALX_KERNEL_OF(module, fold_walls);
  CALX_KERNEL_OF(module, fold_particles);
  CALX_KERNEL_OF(module, fold_chunks);
  CALX_KERNEL_OF(module, fold_drift);
  CALX_KERNEL_OF(module, close_sums);
  CALX_KERNEL_OF(module, close_step);
  CALX_KERNEL_OF(module, close_drift);
  CALX_KERNEL_OF(module, make_chunks);
  CALX_KERNEL_OF(list_module, wrap_particles);
  CALX_KERNEL_OF(list_module, add_wrapped);
  CALX_KERNEL_OF(list_module, measure_spheres);
  CALX_KERNEL_OF(list_module, measure_particles);
  CALX_KERNEL_OF(list_module, join_extents);
  CALX_KERNEL_OF(list_module, morton_keys);
  CALX_KERNEL_OF(list_module, count_digits);
  CALX_KERNEL_OF(list_module, move_by_digit);
  CALX_KERNEL_OF(list_module, take_rows);
  CALX_KERNEL_OF(list_module, count_members);
  CALX_KERNEL_OF(list_module, order_members);
  CALX_KERNEL_OF(list_module, set_margins);
  CALX_KERNEL_OF(list_module, keep_places);
  CALX_KERNEL_OF(list_module, count_classes);
  CALX_KERNEL_OF(list_module, count_cells);
  CALX_KERNEL_OF(list_module, fill_cells);
  CALX_KERNEL_OF(list_module, search_pairs);
  CALX_KERNEL_OF(list_module, sort_pairs);
  CALX_KERNEL_OF(list_module, note_incoming);
  CALX_KERNEL_OF(list_module, sort_incoming);
  CALX_KERNEL_OF(list_module, carry_pairs);
  CALX_KERNEL_OF(list_module, search_parts);
  CALX_KERNEL_OF(list_module, carry_rows);
#undef CALX_KERNEL_OF
  m.put(m.law_of, contact_text.law_of);
  m.put(m.law_numbers, contact_text.numbers);
  m.put(m.force_numbers, force_text.numbers);
  m.put(m.odd, std::vector<std::uint32_t>(engine_.history_.odd.begin(), engine_.history_.odd.end()));
  m.reserve(m.flags, flag_count * sizeof(std::uint32_t));
  m.reserve(m.totals, (result_width() + 2) * sizeof(double));
}

Engine::OnDevice::Numbers Engine::OnDevice::numbers(double dt) const {
  const EngineOptions& o = engine_.options;
  Numbers n{};
  n.dt = dt;
  n.overlap_limit = o.overlap_limit;
  n.gravity = o.gravity;
  n.low = o.domain.lo;
  n.high = o.domain.hi;
  n.length = o.wrap.length;
  n.half_pair_gap = 0.5 * engine_.largest_pair_gap_;
  n.wall_gap = engine_.largest_wall_gap_;
  for (std::size_t k = 0; k < 3; ++k) n.periodic[k] = o.wrap.periodic[k];
  n.spheres = static_cast<std::uint32_t>(engine_.particles.sphere_count());
  n.particles = static_cast<std::uint32_t>(engine_.particles.count());
  n.entries = static_cast<std::uint32_t>(entries_);
  n.wall_rows = static_cast<std::uint32_t>(rows_);
  n.chunks = n.particles == 0 ? 0 : (n.particles - 1) / chunk_length(n.particles) + 1;
  n.parts = static_cast<std::uint32_t>(engine_.parts.size());
  n.materials = engine_.history_.materials;
  n.columns = engine_.history_.columns;
  n.ledger = o.ledger;
  n.forces = !engine_.forces.empty();
  n.part_stride = moving_ ? n.parts : 0;
  return n;
}

void Engine::OnDevice::all_changed() {
  particles_sent_ = lists_sent_ = sums_sent_ = false;
  fetched_ = lists_fetched_ = sums_fetched_ = true;
  permuted_ = false;
}

void Engine::OnDevice::fetch() {
  if (fetched_) return;
  fetched_ = true;
  Memory& m = *memory_;
  Particles& p = engine_.particles;
  if (permuted_) {
    std::vector<std::uint32_t> order(p.count());
    m.take(m.host_rank, order);
    p.permute(order);
    std::iota(order.begin(), order.end(), 0u);
    m.put(m.host_rank, order);
    permuted_ = false;
  }
  m.take(m.body, p.body);
  if (p.has_clumps) m.take(m.member, p.member);
  if (p.has_clumps || engine_.options.verlet) m.take(m.turn, p.turn);
  if (engine_.options.verlet) m.take(m.wrench, p.wrench);
  engine_.margin_.resize(p.count());
  m.take(m.margin, engine_.margin_);
  engine_.reference_.resize(p.sphere_count());
  m.take(m.listed, engine_.reference_);
  engine_.list_rank_.resize(p.sphere_count());
  m.take(m.list_rank, engine_.list_rank_);
  engine_.pairs_.make_chunks(p);
  engine_.results_.resize(engine_.pairs_.chunks.size());
  engine_.used_.resize(engine_.pairs_.chunks.size());
}

void Engine::OnDevice::fetch_lists() {
  if (lists_fetched_) return;
  fetch();
  lists_fetched_ = true;
  Memory& m = *memory_;
  PairList& pairs = engine_.pairs_;
  pairs.columns = engine_.history_.columns;
  pairs.i.resize(entries_);
  pairs.j.resize(entries_);
  pairs.touching.resize(entries_);
  pairs.history.resize(entries_ * pairs.columns);
  m.take(m.pair_i, pairs.i);
  m.take(m.pair_j, pairs.j);
  m.take(m.pair_touching, pairs.touching);
  m.take(m.pair_history, pairs.history);
  WallList& walls = engine_.walls_;
  const std::size_t slots = rows_ * kWallContacts;
  walls.sphere.resize(rows_);
  walls.part.resize(rows_);
  walls.first_element.assign(rows_ + 1, 0);
  walls.elements.resize(elements_);
  walls.touching.resize(slots);
  walls.normal.resize(slots);
  walls.stride = wall_stride_;
  walls.history.resize(wall_stride_ * engine_.history_.columns);
  m.take(m.row_sphere, walls.sphere);
  m.take(m.row_part, walls.part);
  if (rows_ > 0) m.take(m.first_element, walls.first_element);
  m.take(m.elements, walls.elements);
  m.take(m.wall_touching, walls.touching);
  m.take(m.wall_normals, walls.normal);
  m.take(m.wall_history, walls.history);
}

void Engine::OnDevice::fetch_sums() {
  if (sums_fetched_) return;
  sums_fetched_ = true;
  std::vector<double> s(result_width() + 2);
  memory_->take(memory_->totals, s);
  EngineEnergy& e = engine_.energy_;
  e.elastic = s[sum_elastic];
  e.friction = s[sum_friction];
  e.damping = s[sum_damping];
  e.plastic = s[sum_plastic];
  e.wall_work = s[sum_wall_work];
  e.kinetic_translation = s[sum_translation];
  e.kinetic_rotation = s[sum_rotation];
  e.gravity = s[sum_gravity];
  e.gravity_work = s[sum_gravity_work];
  e.force_work = s[sum_force_work];
  e.wrapped = s[result_width() + 1];
  engine_.touching_ = static_cast<std::uint64_t>(s[sum_touching]);
  engine_.largest_overlap_ = s[result_width()];
  engine_.worst_ = {s[sum_largest], static_cast<std::uint32_t>(s[sum_largest_i]),
                    static_cast<std::uint32_t>(s[sum_largest_j])};
  for (std::size_t k = 0; k < engine_.parts.size(); ++k) {
    const double* w = &s[kSums + 6 * k];
    engine_.parts[k].force = {w[0], w[1], w[2]};
    engine_.parts[k].torque = {w[3], w[4], w[5]};
  }
}

void Engine::OnDevice::send_sums() {
  if (sums_sent_) return;
  sums_sent_ = true;
  const EngineEnergy& e = engine_.energy_;
  std::vector<double> s(result_width() + 2, 0.0);
  s[sum_elastic] = e.elastic;
  s[sum_friction] = e.friction;
  s[sum_damping] = e.damping;
  s[sum_plastic] = e.plastic;
  s[sum_wall_work] = e.wall_work;
  s[sum_translation] = e.kinetic_translation;
  s[sum_rotation] = e.kinetic_rotation;
  s[sum_gravity] = e.gravity;
  s[sum_gravity_work] = e.gravity_work;
  s[sum_force_work] = e.force_work;
  s[sum_touching] = static_cast<double>(engine_.touching_);
  s[result_width()] = engine_.largest_overlap_;
  s[result_width() + 1] = e.wrapped;
  for (std::size_t k = 0; k < engine_.parts.size(); ++k) {
    const EnginePart& part = engine_.parts[k];
    const Vec3 load[2] = {part.force, part.torque};
    for (std::size_t c = 0; c < 6; ++c) s[kSums + 6 * k + c] = load[c / 3][static_cast<int>(c % 3)];
  }
  memory_->put(memory_->totals, s);
}

std::size_t Engine::OnDevice::memory_bytes() const { return memory_->bytes; }

}  // namespace calx
