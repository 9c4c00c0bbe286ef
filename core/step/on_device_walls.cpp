// on_device_walls.cpp: building the wall list on a device.
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

// Layout of rows.h.
struct DevicePlace {
  Quat turn;
  Vec3 shift;
  double margin;
  std::uint32_t present, shape;
};
static_assert(sizeof(DevicePlace) == 72);

}  // namespace

void Engine::OnDevice::build_walls(double margin_factor) {
  send();
  Memory& m = *memory_;
  Numbers n = numbers(0);
  const std::size_t spheres = n.spheres, u32 = sizeof(std::uint32_t);
  std::vector<DevicePlace> places;
  for (const PartPlace& place : engine_.places_)
    places.push_back({place.turn, place.shift, place.margin, place.present, static_cast<std::uint32_t>(places.size())});
  m.put(m.places, places);
  std::swap(m.wall_first, m.old_wall_first);
  std::swap(m.row_part, m.old_row_part);
  m.reserve(m.counts, (spheres + 1) * u32);
  m.reserve(m.more_counts, (spheres + 1) * u32);
  m.reserve(m.wall_first, (spheres + 1) * u32);
  m.reserve(m.element_first, (spheres + 1) * u32);
  const auto search = [&](const DeviceBuffer& rows, const DeviceBuffer& elements, const DeviceBuffer& to) {
    device_->launch(m.search_parts, spheres,
                    arguments(n, margin_factor, m.spheres(engine_.particles), m.owner, m.margin, m.places, m.shapes,
                              m.triangles, m.axes, m.segments, m.trees, m.nodes, m.tree_elements, rows, elements,
                              m.row_sphere, m.row_part, m.first_element, to));
  };
  const DeviceBuffer none;
  search(m.counts, m.more_counts, none);
  device_->exclusive_scan(m.counts, m.wall_first, spheres);
  device_->exclusive_scan(m.more_counts, m.element_first, spheres);
  rows_ = m.number_at(m.wall_first, spheres);
  elements_ = m.number_at(m.element_first, spheres);
  m.reserve(m.row_sphere, rows_ * u32);
  m.reserve(m.row_part, rows_ * u32);
  m.reserve(m.first_element, (rows_ + 1) * u32);
  m.reserve(m.elements, elements_ * u32);
  if (rows_ > 0) search(m.wall_first, m.element_first, m.elements);

  std::swap(m.wall_touching, m.old_wall_touching);
  std::swap(m.wall_normals, m.old_wall_normals);
  std::swap(m.wall_history, m.old_wall_history);
  const std::uint64_t old_stride = wall_stride_;
  const std::size_t slots = rows_ * kWallContacts;
  wall_stride_ = WallList::stride_of(rows_);
  const std::uint64_t stride = wall_stride_;
  m.reserve(m.wall_touching, slots);
  m.reserve(m.wall_normals, slots * sizeof(Vec3));
  m.reserve(m.wall_history, wall_stride_ * n.columns * sizeof(double));
  n = numbers(0);
  device_->launch(m.carry_rows, rows_,
                  arguments(n, listed_spheres_, m.list_rank, m.row_sphere, m.row_part, m.old_wall_first, m.old_row_part,
                            m.old_wall_touching, m.old_wall_normals, m.old_wall_history, old_stride, m.wall_touching,
                            m.wall_normals, m.wall_history, stride));
  size_step();
  fetched_ = lists_fetched_ = sums_fetched_ = false;
}

}  // namespace calx
