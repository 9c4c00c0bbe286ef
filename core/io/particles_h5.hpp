// particles_h5.hpp: particles.h5, the frames for h5py, shaped after H5MD 1.1 (de Buyl, Colberg, Hofling 2014, Comput.
// Phys. Commun. 185, 1546).
//
//   particles/spheres/{position,velocity,radius,id,particle,material,contacts,count}/{step,time,value}
//   particles/spheres/box                 attributes dimension, boundary; datasets edges, origin
//   parts/<name>/{vertices,triangles}     part frame; attributes name, geometry, material, index
//   parts/<name>/pose/{step,time,quaternion,shift,present}
//
// value is [frame][row] or [frame][row][axis]. The number of spheres changes: in frame k the first count/value[k] rows
// hold spheres, the others NaN or 4294967295. Rows are in rank order, which changes: id follows one sphere, particle
// its clump. A part's point X is at shift + rotate(quaternion, X) with quaternion w x y z. Units stand in the attribute
// "unit". Each frame opens, extends and closes the file (staged_file.hpp), so that it can be read while the run goes
// on.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "io/frame_columns.hpp"

namespace calx {

class ParticlesH5 {
 public:
  /// resume_at >= 0: frames later than that are dropped; else an older file is deleted.
  ParticlesH5(const std::string& path, double resume_at);
  void append(const WorldView& world, const FrameColumns& frame, const std::vector<PartShape>& parts);

 private:
  void create(const WorldView& world, const std::vector<PartShape>& parts) const;
  std::string path_;
};

/// Of the file: all datasets that grow by one row each frame.
std::vector<std::string> growing_datasets(const std::vector<std::string>& part_groups);

}  // namespace calx
