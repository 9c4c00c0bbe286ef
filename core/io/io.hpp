// io.hpp: the files of a run's folder: checkpoints, frames for ParaView, HDF5 results, CSV series, text.
// Every write that fails (disk full, unwritable) throws Error(Fault::files) naming the path and the reason, and leaves
// what was written before intact.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/state.hpp"
#include "measure/measure.hpp"

namespace calx {

/// Text to a temporary file in the same folder, flushed, then renamed over path.
void write_text_atomically(const std::string& path, const std::string& text);
std::string read_text(const std::string& path);

/// checkpoint.h5 in dir, atomically; the one before is kept as checkpoint.previous.h5.
void write_checkpoint(const std::string& dir, const std::function<void(StateWriter&)>& save);
/// The newest readable checkpoint of dir; a damaged newest one falls back to the previous with a note. Throws
/// Error(Fault::files) when there is none.
std::unique_ptr<StateReader> read_checkpoint(const std::string& dir, std::string* note = nullptr);

/// One CSV per sensor: header time_s,<columns>, one row per sample, flushed so that a killed run keeps its rows.
class SeriesFile {
 public:
  /// resume_at >= 0: keeps rows with time <= resume_at and appends; else starts anew.
  SeriesFile(const std::string& path, const std::vector<std::string>& columns, double resume_at);
  ~SeriesFile();
  void write(double time, const std::vector<double>& values);
  /// Of the last row kept on resuming, without its time; empty when there is none.
  const std::vector<double>& last_values() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// frames/particles_000012.vtp, frames/<part>_000012.vtp, frames.pvd and particles.h5 (H5MD-shaped; parts under
/// parts/<name>/{vertices,triangles,pose}). ParaView 5.11 opens the .pvd: spheres as points with radius, diameter,
/// clump id, velocity, material, contact count; walls moved to their pose.
class FrameWriter {
 public:
  FrameWriter(const std::string& dir, bool particles_h5, double resume_at);
  ~FrameWriter();
  void write(const WorldView& world);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Frames read back from particles.h5, for the report.
struct FrameData {
  double time = 0;
  std::vector<float> x, y, z, radius, speed;  // per sphere
  std::vector<std::uint32_t> particle;        // id of the sphere's particle
  struct PartPose {
    bool present = true;
    Quat turn;
    Vec3 shift;
  };
  std::vector<PartPose> parts;
};
struct PartMesh {
  std::string name, geometry, material;
  std::vector<float> vertices;  // x y z, part frame
  std::vector<std::uint32_t> triangles;
};
struct FrameSet {
  std::vector<PartMesh> parts;
  std::vector<double> times;
};
FrameSet read_frame_set(const std::string& dir);  // empty when there is no particles.h5
FrameData read_frame(const std::string& dir, std::size_t number);

}  // namespace calx
