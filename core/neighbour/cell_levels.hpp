// cell_levels.hpp: which spheres share a grid.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace calx {

/// Numbers of spheres by reach: classes of rising reach, at most 32, each an equal part of an octave.
class ReachClasses {
 public:
  static constexpr std::uint32_t kMost = 32;
  struct Class {
    std::uint64_t count = 0;
    double largest = 0;  // m
  };
  /// For reaches from the smallest to the largest, m, both >= 0.
  ReachClasses(double smallest, double largest);
  std::uint32_t class_count() const { return count_; }
  /// The smallest reach of a class, m.
  double lower_bound(std::uint32_t number) const;
  std::uint32_t class_of(double reach) const { return static_cast<std::uint32_t>((key(reach) - first_) >> shift_); }

 private:
  static std::uint64_t key(double reach);
  std::uint64_t first_;
  std::uint32_t shift_, count_;
};

/// The largest reach of each level, rising: the classes joined so that the search costs least by an estimate.
std::vector<double> choose_levels(const std::vector<ReachClasses::Class>& classes);

}  // namespace calx
