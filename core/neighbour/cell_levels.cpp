#include "neighbour/cell_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace calx {

// The bits of a double >= 0 rise with it; the upper 3 bits of the mantissa cut an octave in eight.
std::uint64_t ReachClasses::key(double reach) {
  std::uint64_t bits;
  std::memcpy(&bits, &reach, sizeof bits);
  return bits >> 49;
}

ReachClasses::ReachClasses(double smallest, double largest) : first_(key(smallest)), shift_(0) {
  const std::uint64_t span = key(largest) - first_;
  while (span >> shift_ >= kMost) ++shift_;
  count_ = static_cast<std::uint32_t>(span >> shift_) + 1;
}

double ReachClasses::lower_bound(std::uint32_t number) const {
  const std::uint64_t bits = (first_ + (std::uint64_t{number} << shift_)) << 49;
  double reach;
  std::memcpy(&reach, &bits, sizeof reach);
  return reach;
}

namespace {

// Instructions, counted on x86-64-v3; only their ratios matter.
constexpr double kRow = 20, kWindowRow = 90;  // for a row of the own level; of a finer one
constexpr double kEight = 33;                 // for eight comparisons of a row
constexpr double kLevel = 5000;               // for a grid as such

double tests(double candidates) { return kEight * std::max(1.0, candidates / 8 + 0.5); }

}  // namespace

std::vector<double> choose_levels(const std::vector<ReachClasses::Class>& classes) {
  std::vector<ReachClasses::Class> c;
  for (const auto& k : classes)
    if (k.count > 0) c.push_back(k);
  const std::size_t n = c.size();
  // Spheres of a packed bed fill three fifths of the space, together with a tenth of margin four fifths.
  double volume = 0;
  for (const auto& k : c) volume += static_cast<double>(k.count) * 4.19 / 0.8 * k.largest * k.largest * k.largest;
  // best[b]: least cost of the classes before b; from[b]: where its last level starts.
  std::vector<double> best(n + 1, 0);
  std::vector<std::size_t> from(n + 1, 0);
  for (std::size_t b = 1; b <= n; ++b) {
    double count = 0;
    for (std::size_t a = b; a-- > 0;) {
      count += static_cast<double>(c[a].count);
      const double reach = c[b - 1].largest, cell = 2 * reach, density = count / volume;
      double cost = kLevel + count * 5 * (kRow + tests(3 * density * cell * cell * cell));
      for (std::size_t k = b; k < n; ++k) {
        const double far = reach + c[k].largest, cells = 2 * far / cell + 1;
        const double rows = 0.79 * cells * cells;
        const double rowwise = rows * (kWindowRow + tests(0.7 * density * cells * cell * cell * cell));
        cost += static_cast<double>(c[k].count) * std::min(rowwise, tests(count));
      }
      if (a + 1 == b || best[a] + cost < best[b]) {
        best[b] = best[a] + cost;
        from[b] = a;
      }
    }
  }
  std::vector<double> reaches;
  for (std::size_t b = n; b > 0; b = from[b]) reaches.push_back(c[b - 1].largest);
  std::reverse(reaches.begin(), reaches.end());
  return reaches;
}

}  // namespace calx
