// on_device_send.cpp: from the host's world to the device's.
#include "geometry/elements.hpp"
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

// Layouts of walls.h, surfaces.h and rows.h.
struct PartState {
  Quat turn;
  Vec3 shift, centre, velocity, spin;
  std::uint32_t shape, material;
};
struct ShapePlace {
  double size, tolerance;
  std::uint32_t triangles, triangle_count, edges, vertices, inwards, directions, axes, segments, points, alongs;
};
struct TreePlace {
  std::uint32_t first, last, elements, unused;
};
static_assert(sizeof(Record) == 96 && sizeof(Wrench) == 48 && sizeof(Quat) == 32 && sizeof(Vec3) == 24);
static_assert(sizeof(PartState) == 136 && sizeof(ShapePlace) == 56 && sizeof(geometry::FlatTree::Node) == 64);
static_assert(sizeof(geometry::Triangle) == 192 && sizeof(geometry::Edge) == 88 && sizeof(geometry::Vertex) == 56);
static_assert(sizeof(geometry::Axis) == 96 && sizeof(geometry::Segment) == 72 && sizeof(geometry::ProfilePoint) == 48 &&
              sizeof(geometry::Planar) == 16);

}  // namespace

void Engine::OnDevice::send_shapes() {
  using namespace geometry;
  Memory& m = *memory_;
  Elements all;
  std::vector<ShapePlace> places;
  std::vector<TreePlace> trees;
  FlatTree forest;
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
    const FlatTree tree = part.surface->flat_tree();
    const auto first = static_cast<std::uint32_t>(forest.nodes.size());
    trees.push_back(
        {first, first + static_cast<std::uint32_t>(tree.nodes.size()), append(forest.order, tree.order), 0});
    for (FlatTree::Node node : tree.nodes) {
      node.skip += first;
      forest.nodes.push_back(node);
    }
  }
  m.put(m.trees, trees);
  m.put(m.nodes, forest.nodes);
  m.put(m.tree_elements, forest.order);
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
  m.reserve(m.parts, kBatch * engine_.parts.size() * sizeof(PartState));
  m.reserve(m.times, kBatch * sizeof(double));
}

void Engine::OnDevice::send_table(const StepTable& table, std::size_t first, std::size_t count) {
  Memory& m = *memory_;
  const std::size_t width = engine_.parts.size();
  std::vector<PartState> states;
  for (std::size_t step = first; step < first + (moving_ ? count : 1); ++step)
    for (std::size_t k = 0; k < width; ++k) {
      const Pose& pose = table.poses[step * width + k];
      states.push_back({pose.turn, pose.shift, pose.centre, pose.velocity, pose.spin, static_cast<std::uint32_t>(k),
                        engine_.parts[k].material});
    }
  device_->write(m.parts, states.data(), states.size() * sizeof(PartState));
  device_->write(m.times, &table.time[first], count * sizeof(double));
}

void Engine::OnDevice::send_particles() {
  Memory& m = *memory_;
  const Particles& p = engine_.particles;
  m.put(m.body, p.body);
  std::vector<std::uint32_t> material, ranks(p.count());
  for (std::size_t s = 0; s < p.sphere_count(); ++s) material.push_back(p.material[p.owner_of(s)]);
  m.put(m.sphere_material, material);
  for (std::uint32_t k = 0; k < ranks.size(); ++k) ranks[k] = k;
  m.put(m.host_rank, ranks);
  m.put(m.margin, engine_.margin_);
  m.put(m.listed, engine_.reference_);
  m.put(m.list_rank, engine_.list_rank_);
  const bool verlet = engine_.options.verlet;
  if (!engine_.forces.empty()) {
    std::vector<double> radius;
    for (std::size_t k = 0; k < p.count(); ++k) radius.push_back(p.equal_radius(k));
    m.put(m.equal_radius, radius);
  }
  if (verlet) m.put(m.wrench, p.wrench);
  if (!p.has_clumps && !verlet) return;
  m.put(m.turn, p.turn);
  std::vector<Vec3> inertia, arms;
  for (std::size_t k = 0; k < p.count(); ++k) {
    inertia.push_back(p.inertia(k));
    for (const auto& member : p.shapes[p.shape[k]].members) arms.push_back(p.scale[k] * member.at);
  }
  m.put(m.inertia, inertia);
  m.put(m.arms, arms);
  if (!p.has_clumps) return;
  m.put(m.member, p.member);
  m.put(m.first_sphere, p.first_sphere);
  m.put(m.owner, p.owner);
}

void Engine::OnDevice::send_gaps() {
  std::vector<double> gaps = engine_.pair_gaps_;
  gaps.insert(gaps.end(), engine_.wall_gaps_.begin(), engine_.wall_gaps_.end());
  memory_->put(memory_->gaps, gaps);
}

// Lists that the host has built, of a checkpoint.
void Engine::OnDevice::send_lists() {
  send_gaps();
  Memory& m = *memory_;
  const PairList& pairs = engine_.pairs_;
  const std::size_t n = engine_.particles.sphere_count();
  listed_spheres_ = static_cast<std::uint32_t>(n);
  entries_ = pairs.entry_count();
  std::vector<std::uint32_t> first(n + 1, 0);
  for (const std::uint32_t i : pairs.i) ++first[i + 1];
  for (std::size_t s = 0; s < n; ++s) first[s + 1] += first[s];
  m.put(m.row_first, first);
  m.put(m.pair_j, pairs.j);
  m.put(m.pair_touching, pairs.touching);
  m.put(m.pair_history, pairs.history);
  const WallList& walls = engine_.walls_;
  rows_ = walls.row_count();
  elements_ = walls.elements.size();
  wall_stride_ = walls.stride;
  m.put(m.row_sphere, walls.sphere);
  m.put(m.row_part, walls.part);
  m.put(m.first_element, walls.first_element);
  m.put(m.elements, walls.elements);
  m.put(m.wall_touching, walls.touching);
  m.put(m.wall_normals, walls.normal);
  m.put(m.wall_history, walls.history);
  first.assign(n + 1, 0);
  for (const std::uint32_t s : walls.sphere) ++first[s + 1];
  for (std::size_t s = 0; s < n; ++s) first[s + 1] += first[s];
  m.put(m.wall_first, first);
  const Numbers now = numbers(0);
  link_entries(now);
  make_chunks(now);
  size_step();
}

void Engine::OnDevice::send() {
  if (!particles_sent_) send_particles();
  particles_sent_ = true;
  if (!lists_sent_) send_lists();
  lists_sent_ = true;
  send_sums();
}

}  // namespace calx
