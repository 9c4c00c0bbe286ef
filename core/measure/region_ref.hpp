// region_ref.hpp: a region as a sensor sees it, at rest or carried by a part; null settings stand for everywhere.
#pragma once
#include <string>

#include "measure/world.hpp"

namespace calx {

/// Number of a part of the case by its name. [main]
inline std::size_t part_number(const WorldView& world, const std::string& name) {
  std::size_t part = 0;
  while (part + 1 < world.part_count() && world.part_name(part) != name) ++part;
  return part;
}

class RegionRef {
 public:
  RegionRef() = default;
  explicit RegionRef(const RegionSettings* region) {
    if (region) region_ = *region, everywhere_ = false;
  }
  bool everywhere() const { return everywhere_; }
  const RegionSettings& settings() const { return region_; }
  bool contains(const WorldView& world, const Vec3& p) const { return everywhere_ || world.in_region(region_.name, p); }
  /// Takes the region from where the case draws it to where it is now; identity for a fixed region.
  Pose pose(const WorldView& world) const {
    return region_.follows.empty() ? Pose{} : world.part_pose(part_number(world, region_.follows));
  }
  /// Axis-aligned box around the region as it stands now.
  Box bounds(const WorldView& world) const {
    const Box rest = region_.bounds();
    const Pose at = pose(world);
    Box box;
    for (int corner = 0; corner < 8; ++corner)
      box.add(at.to_world({corner & 1 ? rest.hi.x : rest.lo.x, corner & 2 ? rest.hi.y : rest.lo.y,
                           corner & 4 ? rest.hi.z : rest.lo.z}));
    return box;
  }

 private:
  RegionSettings region_;
  bool everywhere_ = true;
};

}  // namespace calx
