// on_device_send.cpp: from the host's world to the device's.
#include "geometry/elements.hpp"
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

// Layouts of walls.h, surfaces.h and fold.h.
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

}  // namespace

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
  const bool pulled = !engine_.forces.empty();
  if (pulled) {
    std::vector<double> radius;
    for (std::size_t k = 0; k < p.count(); ++k) radius.push_back(p.equal_radius(k));
    m.put(m.equal_radius, radius);
    m.reserve(m.added, p.count() * sizeof(Wrench));
  }
  if (engine_.options.ledger || verlet || pulled)
    m.reserve(m.particle_energy, kParticleEnergies * p.count() * sizeof(double));
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
    m.particle_spans += span_count(c.last_particle - c.first_particle);
    m.sphere_spans += span_count(c.last_sphere - c.first_sphere);
  }
  const std::size_t width = result_width();
  m.put(m.chunks, chunks);
  m.reserve(m.pair_sums, m.sphere_spans * kSums * sizeof(double));
  m.reserve(m.wall_sums, m.sphere_spans * width * sizeof(double));
  m.reserve(m.particle_sums, m.particle_spans * kParticleEnergies * sizeof(double));
  m.reserve(m.chunk_sums, chunks.size() * width * sizeof(double));
}

void Engine::OnDevice::send_lists() {
  if (current_) return;
  send_particles();
  send_pairs();
  send_walls();
  send_chunks();
  current_ = true;
}

}  // namespace calx
