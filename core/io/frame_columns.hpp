// frame_columns.hpp: one moment of a run as the arrays that both frame formats take.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "measure/world.hpp"

namespace calx {

/// One row per sphere, rank order, SI, world frame.
struct FrameColumns {
  double time = 0;
  std::uint64_t step = 0;
  std::vector<double> position;  // x y z
  std::vector<float> velocity;   // x y z, of the sphere's centre
  std::vector<float> radius;
  std::vector<std::uint32_t> sphere, particle, material, contacts;
  std::size_t count() const { return radius.size(); }
};
FrameColumns frame_columns(const WorldView& world);

/// A part's triangles in its own frame; they do not change during a run.
struct PartShape {
  std::string name, geometry, material;
  std::uint32_t material_index = 0;
  std::vector<float> vertices;  // x y z, m
  std::vector<std::uint32_t> triangles;
};
std::vector<PartShape> part_shapes(const WorldView& world);

/// Distinct names that are safe in a file name and an HDF5 path, in the order of the names given. taken: not to be
/// used.
std::vector<std::string> safe_names(const std::vector<std::string>& names, const std::string& taken);

}  // namespace calx
