// sample_run.hpp: five frames of a fake world, the same for the C++ tests and for the readers in Python.
#pragma once
#include <string>

#include "fake_world.hpp"
#include "io/io.hpp"

namespace calx_test {

constexpr int sample_frames = 5;
/// More than two chunks of particles.h5, so that chunk borders are crossed.
constexpr std::size_t sample_counts[sample_frames] = {0, 3, 2500, 5, 4};

/// Frame k: t = k/10 s, step 1000 k; the hopper stands still and is absent in frame 3; the rotor turns by k/4 rad about
/// z and is shifted by k metres along x; frame 4 holds clumps of two.
inline void set_frame(FakeWorld& world, int k) {
  world.at(k / 10.0, 1000 * static_cast<std::uint64_t>(k));
  world.fill(sample_counts[k], k == 4);
  world.present[0] = k != 3;
  world.poses[1].turn = about_z(k / 4.0);
  world.poses[1].shift = {static_cast<double>(k), 0, 0};
}

inline void write_sample(const std::string& dir, int first = 0, int last = sample_frames - 1, double resume_at = -1) {
  FakeWorld world;
  calx::FrameWriter writer(dir, true, resume_at);
  for (int k = first; k <= last; ++k) {
    set_frame(world, k);
    writer.write(world);
  }
}

}  // namespace calx_test
