#include "neighbour/morton.hpp"

#include <omp.h>

#include <algorithm>
#include <utility>

namespace calx {
namespace {

/// Bits 0 .. 20 of v, two zeros after each.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x1F00000000FFFFull;
  v = (v | v << 16) & 0x1F0000FF0000FFull;
  v = (v | v << 8) & 0x100F00F00F00F00Full;
  v = (v | v << 4) & 0x10C30C30C30C30C3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

/// Cells beyond 2^21 along a direction share keys with nearer ones; a few stray particles do no harm.
std::uint64_t cell_number(double x) { return static_cast<std::uint64_t>(x < 9e18 ? x : 9e18); }

using Keyed = std::pair<std::uint64_t, std::uint32_t>;

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

/// Stable sort by the digit at `shift`. Returns false, and sorts nothing, when all have the same.
bool sort_by_digit(const std::vector<Keyed>& from, std::vector<Keyed>& to, int shift, std::size_t blocks,
                   std::vector<std::uint32_t>& next) {
  const std::size_t n = from.size();
  auto digit = [&](const Keyed& k) { return (k.first >> shift) & (kDigits - 1); };
  next.assign(blocks * kDigits, 0);
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t k = n * b / blocks; k < n * (b + 1) / blocks; ++k) ++next[b * kDigits + digit(from[k])];
  std::uint32_t sum = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    const std::uint32_t before = sum;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint32_t count = next[b * kDigits + d];
      next[b * kDigits + d] = sum;
      sum += count;
    }
    if (sum - before == n) return false;
  }
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t k = n * b / blocks; k < n * (b + 1) / blocks; ++k)
      to[next[b * kDigits + digit(from[k])]++] = from[k];
  return true;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const Particles& particles, double cell) {
  const std::size_t n = particles.count();
  const double inverse = 1 / cell;
  Box box;
  for (const auto& b : particles.body) box.add(position(b));
  std::vector<Keyed> keys(n), sorted(n);
  std::uint64_t used = 0;
#pragma omp parallel for schedule(static) reduction(| : used)
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 d = (position(particles.body[k]) - box.lo) * inverse;
    keys[k] = {spread(cell_number(d.x)) | spread(cell_number(d.y)) << 1 | spread(cell_number(d.z)) << 2,
               static_cast<std::uint32_t>(k)};
    used |= keys[k].first;
  }
  const std::size_t blocks = n < 20000 ? 1 : static_cast<std::size_t>(omp_get_max_threads());
  std::vector<std::uint32_t> next;
  for (int shift = 0; shift < 63 && used >> shift; shift += kDigitBits)
    if (sort_by_digit(keys, sorted, shift, blocks, next)) keys.swap(sorted);
  std::vector<std::uint32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = keys[k].second;
  return order;
}

}  // namespace calx
