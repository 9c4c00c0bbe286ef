#include "step/on_device.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "compute/law_text.hpp"
#include "geometry/elements.hpp"

namespace calx {
namespace {

// Layouts and numbers shared with core/kernels: world.h, walls.h, surfaces.h, fold.h.
enum Flag { flag_stale, flag_guard, flag_missing_law, flag_count };
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
  sum_gravity_work
};
constexpr std::size_t kPairValues = 9, kWallValues = 10, kEnergies = 4, kParticleEnergies = 8;

struct PartState {
  Quat turn;
  Vec3 shift, centre, velocity, spin;
  std::uint32_t shape, material;
};
struct ShapePlace {
  double size, tolerance;
  std::uint32_t triangles, triangle_count, edges, vertices, inwards, directions, axes, segments, points, alongs;
};
struct DeviceChunk {
  std::uint32_t first_particle, last_particle, first_sphere, last_sphere, first_particle_span, first_sphere_span;
};
static_assert(sizeof(Record) == 96 && sizeof(Wrench) == 48 && sizeof(Quat) == 32 && sizeof(Vec3) == 24);
static_assert(sizeof(PartState) == 136 && sizeof(ShapePlace) == 56 && sizeof(DeviceChunk) == 24);
static_assert(sizeof(geometry::Triangle) == 192 && sizeof(geometry::Edge) == 88 && sizeof(geometry::Vertex) == 56);
static_assert(sizeof(geometry::Axis) == 96 && sizeof(geometry::Segment) == 72 && sizeof(geometry::ProfilePoint) == 48 &&
              sizeof(geometry::Planar) == 16);

std::uint32_t spans(std::uint32_t length) { return (length + kSpan - 1) / kSpan; }

std::uint32_t as_index(double number) { return static_cast<std::uint32_t>(number); }

}  // namespace

/// step_numbers of world.h.
struct Engine::OnDevice::Numbers {
  double dt;
  Vec3 gravity, low, high, length;
  std::uint32_t periodic[3];
  std::uint32_t spheres, particles, entries, wall_rows, chunks, parts, materials, columns, ledger;
};

/// Buffers and kernels.
struct Engine::OnDevice::Memory {
  explicit Memory(Device& d) : device(d) {}
  Device& device;
  DeviceModule module;
  DeviceKernel pair_contacts, wall_contacts, sum_contacts, move_spheres, move_clumps, drift_spheres, drift_clumps,
      kick_particles, fold_pairs, fold_walls, fold_particles, fold_chunks;
  // Of the case.
  DeviceBuffer law_of, law_numbers, shapes, triangles, edges, vertices, inwards, directions, axes, segments, points,
      alongs, parts;
  // Of the lists.
  DeviceBuffer body, member, turn, wrench, inertia, first_sphere, arms, sphere_material, margin, listed;
  DeviceBuffer pair_i, pair_j, pair_touching, pair_history, row_first, in_first, in_middle, in_entry;
  DeviceBuffer row_sphere, row_part, first_element, elements, wall_touching, wall_normals, wall_history, wall_first,
      wall_counts;
  DeviceBuffer chunks;
  // Of a step.
  DeviceBuffer pair_out, pair_share, pair_energy, wall_out, wall_share, wall_energy, sums, particle_energy, pair_sums,
      wall_sums, particle_sums, chunk_sums, flags;
  std::uint32_t sphere_spans = 0, particle_spans = 0;
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

Engine::OnDevice::OnDevice(std::unique_ptr<Device> device, Engine& engine, bool fast)
    : device_(std::move(device)), engine_(engine), memory_(std::make_unique<Memory>(*device_)) {
  build(fast);
  send_shapes();
}

Engine::OnDevice::~OnDevice() = default;

void Engine::OnDevice::build(bool fast) {
  Memory& m = *memory_;
  const LawProgram laws = law_program(engine_.laws);
  ModuleText text;
  text.label = "step";
  text.fast = fast;
  const bool mixed = engine_.options.mixed;
  text.add("world.h");
  if (mixed) {
    text.add_laws(32, laws.laws);
    text.add("laws of the case", laws.text);
    text.add("contacts.h");
  }
  text.add_laws(64, laws.laws);
  text.add("laws of the case", laws.text);
  for (const char* part : {"contacts.h", "surfaces.h", "walls.h", "motion.h", "fold.h"}) text.add(part);
  m.module = device_->build(text);
  m.pair_contacts = m.module.kernel(mixed ? "pair_contacts_f32" : "pair_contacts_f64");
  m.wall_contacts = m.module.kernel("wall_contacts");
  m.sum_contacts = m.module.kernel(mixed ? "sum_contacts_mixed" : "sum_contacts");
  m.move_spheres = m.module.kernel("move_spheres");
  m.move_clumps = m.module.kernel("move_clumps");
  m.drift_spheres = m.module.kernel("drift_spheres");
  m.drift_clumps = m.module.kernel("drift_clumps");
  m.kick_particles = m.module.kernel("kick_particles");
  m.fold_pairs = m.module.kernel("fold_pairs");
  m.fold_walls = m.module.kernel("fold_walls");
  m.fold_particles = m.module.kernel("fold_particles");
  m.fold_chunks = m.module.kernel("fold_chunks");
  m.put(m.law_of, laws.law_of);
  m.put(m.law_numbers, laws.numbers);
  m.reserve(m.flags, flag_count * sizeof(std::uint32_t));
}

void Engine::OnDevice::send_shapes() {
  using namespace geometry;
  Memory& m = *memory_;
  Elements all;
  std::vector<ShapePlace> places;
  const auto append = [](auto& to, const auto& from) {
    const auto first = static_cast<std::uint32_t>(to.size());
    to.insert(to.end(), from.begin(), from.end());
    return first;
  };
  for (const EnginePart& part : engine_.parts) {
    const Elements& e = part.surface->elements();
    ShapePlace place{};
    place.size = e.size;
    place.tolerance = e.tolerance;
    place.triangle_count = static_cast<std::uint32_t>(e.triangles.size());
    place.triangles = append(all.triangles, e.triangles);
    place.edges = append(all.edges, e.edges);
    place.vertices = append(all.vertices, e.vertices);
    place.inwards = append(all.edge_inward, e.edge_inward);
    place.directions = append(all.vertex_direction, e.vertex_direction);
    place.axes = append(all.axes, e.axes);
    place.segments = append(all.segments, e.segments);
    place.points = append(all.points, e.points);
    place.alongs = append(all.point_direction, e.point_direction);
    places.push_back(place);
  }
  m.put(m.shapes, places);
  m.put(m.triangles, all.triangles);
  m.put(m.edges, all.edges);
  m.put(m.vertices, all.vertices);
  m.put(m.inwards, all.edge_inward);
  m.put(m.directions, all.vertex_direction);
  m.put(m.axes, all.axes);
  m.put(m.segments, all.segments);
  m.put(m.points, all.points);
  m.put(m.alongs, all.point_direction);
}

void Engine::OnDevice::send_parts() {
  std::vector<PartState> states;
  for (const EnginePart& part : engine_.parts)
    states.push_back({part.pose.turn, part.pose.shift, part.pose.centre, part.pose.velocity, part.pose.spin,
                      static_cast<std::uint32_t>(states.size()), part.material});
  memory_->put(memory_->parts, states);
}

void Engine::OnDevice::send_particles() {
  Memory& m = *memory_;
  const Particles& p = engine_.particles;
  m.put(m.body, p.body);
  std::vector<std::uint32_t> material;
  for (std::size_t s = 0; s < p.sphere_count(); ++s) material.push_back(p.material[p.owner_of(s)]);
  m.put(m.sphere_material, material);
  m.put(m.margin, engine_.margin_);
  m.put(m.listed, engine_.reference_);
  m.reserve(m.sums, p.sphere_count() * sizeof(Wrench));
  const bool verlet = engine_.options.verlet;
  if (engine_.options.ledger || verlet) m.reserve(m.particle_energy, kParticleEnergies * p.count() * sizeof(double));
  if (verlet) m.put(m.wrench, p.wrench);
  if (!p.has_clumps && !verlet) return;
  m.put(m.turn, p.turn);
  std::vector<Vec3> inertia, arms;
  for (std::size_t k = 0; k < p.count(); ++k) {
    inertia.push_back(p.inertia(k));
    for (const auto& member : p.shapes[p.shape[k]].members) arms.push_back(p.scale[k] * member.at);
  }
  if (p.has_clumps) {
    m.put(m.member, p.member);
    m.put(m.first_sphere, p.first_sphere);
  }
  m.put(m.inertia, inertia);
  m.put(m.arms, arms);
}

void Engine::OnDevice::send_pairs() {
  Memory& m = *memory_;
  const PairList& list = engine_.pairs_;
  const std::size_t n = engine_.particles.sphere_count(), entries = list.entry_count();
  m.put(m.pair_i, list.i);
  m.put(m.pair_j, list.j);
  m.put(m.pair_touching, list.touching);
  m.put(m.pair_history, list.history);
  m.reserve(m.pair_out, kPairValues * entries * (engine_.options.mixed ? sizeof(float) : sizeof(double)));
  m.reserve(m.pair_share, entries * sizeof(double));
  if (engine_.options.ledger) m.reserve(m.pair_energy, kEnergies * entries * sizeof(double));

  std::vector<std::uint32_t> row_first(n + 1, 0), in_first(n + 1, 0), in_middle(n, 0), in_entry(entries);
  for (std::size_t e = 0; e < entries; ++e) {
    ++row_first[list.i[e] + 1];
    ++in_first[list.j[e] + 1];
  }
  for (std::size_t s = 0; s < n; ++s) {
    row_first[s + 1] += row_first[s];
    in_first[s + 1] += in_first[s];
  }
  // First those of the sphere's own chunk, then those of chunks before it; entries rise in both.
  std::vector<std::uint32_t> next(in_first.begin(), in_first.end() - 1);
  for (const bool own : {true, false}) {
    for (const Chunk& c : list.chunks)
      for (std::size_t e = c.first_entry; e < c.last_entry; ++e)
        if ((list.j[e] < c.last_sphere) == own) in_entry[next[list.j[e]]++] = static_cast<std::uint32_t>(e);
    if (own) in_middle = next;
  }
  m.put(m.row_first, row_first);
  m.put(m.in_first, in_first);
  m.put(m.in_middle, in_middle);
  m.put(m.in_entry, in_entry);
}

void Engine::OnDevice::send_walls() {
  Memory& m = *memory_;
  const WallList& list = engine_.walls_;
  const std::size_t n = engine_.particles.sphere_count(), rows = list.row_count(), slots = rows * kWallContacts;
  m.put(m.row_sphere, list.sphere);
  m.put(m.row_part, list.part);
  m.put(m.first_element, list.first_element);
  m.put(m.elements, list.elements);
  m.put(m.wall_touching, list.touching);
  m.put(m.wall_normals, list.normal);
  m.put(m.wall_history, list.history);
  m.reserve(m.wall_counts, rows * sizeof(std::uint32_t));
  m.reserve(m.wall_out, kWallValues * slots * sizeof(double));
  m.reserve(m.wall_share, slots * sizeof(double));
  if (engine_.options.ledger) m.reserve(m.wall_energy, kEnergies * slots * sizeof(double));
  std::vector<std::uint32_t> first(n + 1, 0);
  for (const std::uint32_t s : list.sphere) ++first[s + 1];
  for (std::size_t s = 0; s < n; ++s) first[s + 1] += first[s];
  m.put(m.wall_first, first);
}

void Engine::OnDevice::send_chunks() {
  Memory& m = *memory_;
  std::vector<DeviceChunk> chunks;
  m.sphere_spans = m.particle_spans = 0;
  for (const Chunk& c : engine_.pairs_.chunks) {
    chunks.push_back(
        {c.first_particle, c.last_particle, c.first_sphere, c.last_sphere, m.particle_spans, m.sphere_spans});
    m.particle_spans += spans(c.last_particle - c.first_particle);
    m.sphere_spans += spans(c.last_sphere - c.first_sphere);
  }
  const std::size_t width = result_width();
  m.put(m.chunks, chunks);
  m.reserve(m.pair_sums, m.sphere_spans * kSums * sizeof(double));
  m.reserve(m.wall_sums, m.sphere_spans * width * sizeof(double));
  m.reserve(m.particle_sums, m.particle_spans * kParticleEnergies * sizeof(double));
  m.reserve(m.chunk_sums, chunks.size() * width * sizeof(double));
}

Engine::OnDevice::Numbers Engine::OnDevice::numbers(double dt) const {
  const EngineOptions& o = engine_.options;
  Numbers n{};
  n.dt = dt;
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
  return n;
}

void Engine::OnDevice::send_lists() {
  if (current_) return;
  send_particles();
  send_pairs();
  send_walls();
  send_chunks();
  current_ = true;
}

void Engine::OnDevice::drift(double dt) {
  Memory& m = *memory_;
  send_lists();
  const Numbers n = numbers(dt);
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
    const std::size_t end = span + spans(k.last_particle - k.first_particle);
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
                  m.sums, m.wrench, m.listed, m.margin, m.particle_energy, m.flags));
  else if (clumps)
    device_->launch(m.move_clumps, n.particles,
                    arguments(n, m.body, m.member, m.turn, m.inertia, m.first_sphere, m.arms, m.sums, m.listed,
                              m.margin, m.particle_energy, m.flags));
  else
    device_->launch(m.move_spheres, n.particles,
                    arguments(n, m.body, m.sums, m.listed, m.margin, m.particle_energy, m.flags));
}

void Engine::OnDevice::step(double dt) {
  Memory& m = *memory_;
  Device& d = *device_;
  send_lists();
  send_parts();
  const Numbers n = numbers(dt);
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
  if (n.particles > 0) launch_integration(n);
  if (m.sphere_spans > 0) {
    d.launch(m.fold_pairs, m.sphere_spans,
             arguments(n, m.sphere_spans, m.chunks, m.pair_i, m.pair_j, m.row_first, m.pair_touching, m.pair_share,
                       m.pair_energy, m.pair_sums));
    d.launch(m.fold_walls, m.sphere_spans,
             arguments(n, m.sphere_spans, m.chunks, m.wall_first, m.row_sphere, m.row_part, m.wall_counts, m.wall_out,
                       m.wall_share, m.wall_energy, m.wall_sums));
  }
  if (n.ledger && m.particle_spans > 0)
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
  std::vector<double> sums(engine_.results_.size() * width);
  m.take(m.chunk_sums, sums);
  for (std::size_t c = 0; c < engine_.results_.size(); ++c) {
    const double* from = &sums[c * width];
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
