// on_device_order.cpp: particles before a search on a device: back through periodic faces, and in Morton order.
#include "step/on_device_memory.hpp"

namespace calx {
namespace {

/// SORT_BLOCK and SORT_DIGITS of order.h.
constexpr std::size_t kSortBlock = 512, kDigits = 256, kDigitBits = 8;

}  // namespace

void Engine::OnDevice::wrap(const Numbers& n) {
  Memory& m = *memory_;
  const auto spans = static_cast<std::uint32_t>(runs_of(n.particles));
  m.reserve(m.spare, spans * sizeof(double));
  const std::uint32_t clumps = engine_.particles.has_clumps;
  device_->launch(m.wrap_particles, spans,
                  arguments(n, clumps, m.body, m.member, m.turn, m.first_sphere, m.arms, m.spare));
  device_->launch(m.add_wrapped, 1,
                  arguments(spans, m.spare, m.totals, static_cast<std::uint32_t>(result_width() + 1)));
}

const DeviceBuffer& Engine::OnDevice::join_extents(std::size_t runs) {
  Memory& m = *memory_;
  int at = 0;
  for (; runs > 1; runs = runs_of(runs), at = 1 - at)
    device_->launch(m.join_extents, runs_of(runs),
                    arguments(static_cast<std::uint32_t>(runs), m.extents[at], m.extents[1 - at]));
  return m.extents[at];
}

void Engine::OnDevice::reorder(const DeviceBuffer& buffer, const DeviceBuffer& order, std::size_t rows,
                               std::size_t bytes) {
  Memory& m = *memory_;
  m.reserve(m.spare, rows * bytes);
  const auto words = static_cast<std::uint32_t>(bytes / 4);
  const auto items = static_cast<std::uint32_t>(rows * words);
  device_->launch(m.take_rows, items, arguments(items, words, order, buffer, m.spare));
  device_->copy(buffer, m.spare, rows * bytes);
}

void Engine::OnDevice::sort_particles(const Numbers& n) {
  Memory& m = *memory_;
  const Particles& p = engine_.particles;
  const std::size_t count = n.particles, spheres = n.spheres;
  for (DeviceBuffer& each : m.extents) m.reserve(each, runs_of(spheres) * sizeof(DeviceExtent));
  for (int k = 0; k < 2; ++k) {
    m.reserve(m.keys[k], count * sizeof(std::uint64_t));
    m.reserve(m.order[k], count * sizeof(std::uint32_t));
  }
  const auto blocks = static_cast<std::uint32_t>((count + kSortBlock - 1) / kSortBlock);
  m.reserve(m.digit_counts, kDigits * blocks * sizeof(std::uint32_t));
  m.reserve(m.more_counts, (std::max<std::size_t>(kDigits * blocks, spheres) + 1) * sizeof(std::uint32_t));
  m.reserve(m.used, 2 * sizeof(std::uint32_t));
  device_->launch(m.measure_particles, runs_of(count), arguments(n.particles, m.body, m.extents[0]));
  const DeviceBuffer& corner = join_extents(runs_of(count));
  device_->zero(m.used, 2 * sizeof(std::uint32_t));
  device_->launch(m.morton_keys, count,
                  arguments(n.particles, 1 / engine_.cell_, m.body, corner, m.keys[0], m.order[0], m.used));
  std::uint64_t used = 0;
  device_->read(m.used, &used, sizeof used);
  int at = 0;
  for (std::uint32_t shift = 0; shift < 64 && used >> shift; shift += kDigitBits, at = 1 - at) {
    device_->launch(m.count_digits, blocks, arguments(n.particles, blocks, shift, m.keys[at], m.digit_counts));
    device_->exclusive_scan(m.digit_counts, m.more_counts, kDigits * blocks);
    device_->launch(
        m.move_by_digit, blocks,
        arguments(n.particles, blocks, shift, m.keys[at], m.order[at], m.more_counts, m.keys[1 - at], m.order[1 - at]));
  }
  const DeviceBuffer& order = m.order[at];
  const bool verlet = engine_.options.verlet;
  reorder(m.body, order, count, sizeof(Record));
  reorder(m.host_rank, order, count, sizeof(std::uint32_t));
  if (verlet) reorder(m.wrench, order, count, sizeof(Wrench));
  if (n.forces) reorder(m.equal_radius, order, count, sizeof(double));
  if (p.has_clumps || verlet) {
    reorder(m.turn, order, count, sizeof(Quat));
    reorder(m.inertia, order, count, sizeof(Vec3));
  }
  const DeviceBuffer* sphere_order = &order;
  if (p.has_clumps) {
    m.reserve(m.counts, (spheres + 1) * sizeof(std::uint32_t));
    m.reserve(m.sphere_order, spheres * sizeof(std::uint32_t));
    device_->launch(m.count_members, count, arguments(n.particles, order, m.first_sphere, m.counts));
    device_->exclusive_scan(m.counts, m.more_counts, count);
    device_->launch(m.order_members, count,
                    arguments(n.particles, order, m.first_sphere, m.more_counts, m.sphere_order, m.owner));
    device_->copy(m.first_sphere, m.more_counts, (count + 1) * sizeof(std::uint32_t));
    sphere_order = &m.sphere_order;
    reorder(m.member, *sphere_order, spheres, sizeof(Record));
    reorder(m.arms, *sphere_order, spheres, sizeof(Vec3));
  }
  reorder(m.sphere_material, *sphere_order, spheres, sizeof(std::uint32_t));
  reorder(m.list_rank, *sphere_order, spheres, sizeof(std::uint32_t));
  permuted_ = true;
}

}  // namespace calx
