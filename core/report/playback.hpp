// playback.hpp: frames of particles.h5 packed for the browser. Typical: 1e3 to 3e5 spheres, 10 to 1000 frames; what is
// embedded stays below about 25 MB of text.
#pragma once
#include <string>
#include <vector>

#include "report/run_folder.hpp"

namespace calx {

std::string base64(const unsigned char* bytes, std::size_t count);

struct PlaybackLimits {
  std::size_t spheres = 60000;        // beyond: every n-th particle
  std::size_t bytes = 18000000;       // of packed positions before base64
  std::size_t frames = 40;            // as many at least, when recorded and when they fit
  std::size_t small_bytes = 8000000;  // small runs get more frames up to this size,
  std::size_t most_frames = 120;      // and never more than this
};

/// Eight bytes a sphere and frame: x, y, z as 16-bit shares of the box of all positions, then 0 for "not there" or
/// 1 + 65534 sqrt(speed / highest speed). The square root keeps slow motion visible.
struct Playback {
  std::string json;                 // meta data: times, poses, parts, radii, box, speed scale, note
  std::string frames;               // one base64 line per frame
  std::vector<std::size_t> chosen;  // frame numbers in particles.h5
  std::size_t spheres = 0, recorded_spheres = 0;
  std::string note;  // what was left out; empty when nothing was
};
/// set must hold a frame.
Playback pack_playback(const RunFolder& run, const PlaybackLimits& limits = {});

/// The numbers of at most most frames of count, evenly spaced, the first and the last among them.
std::vector<std::size_t> spaced_frames(std::size_t count, std::size_t most);

}  // namespace calx
