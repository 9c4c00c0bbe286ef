// height_map.hpp: the upper envelope of spheres on a grid of square cells, for pile surfaces.
#pragma once
#include <cstddef>
#include <vector>

#include "measure/region_ref.hpp"

namespace calx {

class HeightMap {
 public:
  /// Largest number of cells of one map; 8 bytes each.
  static constexpr std::size_t most_cells = 4000000;

  HeightMap() = default;
  /// Covers x from lo.x to hi.x and y from lo.y to hi.y with whole cells, m; the last ones may stick out.
  HeightMap(const Vec3& lo, const Vec3& hi, double cell);

  /// Raises every cell that the sphere covers to the sphere's highest point over that cell's square; exact.
  void add(const Record& sphere);
  std::size_t nx() const { return nx_; }
  std::size_t ny() const { return ny_; }
  double cell() const { return cell_; }
  Vec3 origin() const { return origin_; }
  double x(std::size_t i) const { return origin_.x + (static_cast<double>(i) + 0.5) * cell_; }
  double y(std::size_t j) const { return origin_.y + (static_cast<double>(j) + 0.5) * cell_; }
  /// Height of cell (i, j), m, world z; NaN where no sphere is.
  double at(std::size_t i, std::size_t j) const { return top_[j * nx_ + i]; }
  const std::vector<double>& values() const { return top_; }

 private:
  Vec3 origin_;
  double cell_ = 0;
  std::size_t nx_ = 0, ny_ = 0;
  std::vector<double> top_;  // row by row, y outer
};

/// Spheres whose centres are in the region, rank order.
std::vector<const Record*> spheres_in(const WorldView& world, const RegionRef& region);

}  // namespace calx
