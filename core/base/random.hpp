// random.hpp: a counter-based random stream. The same seed, stream and counter give the same number on every machine,
// so a resumed run only needs the counter.
#pragma once
#include <cmath>
#include <cstdint>

namespace calx {

class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : key_(mix(seed ^ mix(stream + 0x9E3779B97F4A7C15ull))) {}
  /// 64 uniform bits; splitmix64 (Steele, Lea, Flood 2014) keyed by seed and stream.
  std::uint64_t bits() { return mix(key_ + 0x9E3779B97F4A7C15ull * ++counter); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// Standard normal deviate (Box and Muller 1958); uses two draws.
  double normal() {
    const double u = 1 - uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
  }
  std::uint64_t counter = 0;

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  std::uint64_t key_;
};

}  // namespace calx
