// Frames read back from particles.h5. Only frames that every dataset holds count, so that a cut one is not seen.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "io/files.hpp"
#include "io/h5_file.hpp"
#include "io/io.hpp"
#include "io/particles_h5.hpp"

namespace calx {
namespace {

const std::string spheres = "particles/spheres/";

/// Groups of the parts in the order of the case.
std::vector<std::string> part_groups(const H5File& file) {
  std::vector<std::pair<std::uint64_t, std::string>> found;
  for (const std::string& name : file.members("parts")) {
    const std::string group = "parts/" + name;
    found.emplace_back(file.count(group, "index"), group);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& f : found) out.push_back(std::move(f.second));
  return out;
}

std::uint64_t frame_count(const H5File& file, const std::vector<std::string>& groups) {
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
  for (const std::string& name : growing_datasets(groups)) {
    const H5File::Sizes sizes = file.sizes(name);
    count = std::min(count, sizes.empty() ? 0 : sizes[0]);
  }
  return count;
}

}  // namespace

FrameSet read_frame_set(const std::string& dir) {
  FrameSet out;
  const std::string path = dir + "/particles.h5";
  if (!file_exists(path)) return out;
  const H5File file(path, H5File::Mode::read);
  const std::vector<std::string> groups = part_groups(file);
  for (const std::string& g : groups) {
    out.parts.push_back({file.text(g, "name"), file.text(g, "geometry"), file.text(g, "material"),
                         file.read<float>(g + "/vertices"), file.read<std::uint32_t>(g + "/triangles")});
  }
  out.times = file.read<double>(spheres + "position/time");
  out.times.resize(frame_count(file, groups));
  return out;
}

FrameData read_frame(const std::string& dir, std::size_t number) {
  const H5File file(dir + "/particles.h5", H5File::Mode::read);
  const std::vector<std::string> groups = part_groups(file);
  const std::uint64_t frames = frame_count(file, groups);
  if (number >= frames) {
    throw Error(Fault::files, file.name() + ": there is no frame " + std::to_string(number) + "; it holds " +
                                  std::to_string(frames) + ", counted from 0");
  }
  FrameData out;
  out.time = file.read_row<double>(spheres + "position/time", number, 1).at(0);
  const std::uint64_t count = file.read_row<std::uint64_t>(spheres + "count/value", number, 1).at(0);
  const std::vector<float> position = file.read_row<float>(spheres + "position/value", number, count);
  const std::vector<float> velocity = file.read_row<float>(spheres + "velocity/value", number, count);
  out.radius = file.read_row<float>(spheres + "radius/value", number, count);
  out.particle = file.read_row<std::uint32_t>(spheres + "particle/value", number, count);
  for (std::size_t i = 0; i < out.radius.size(); ++i) {
    out.x.push_back(position[3 * i]);
    out.y.push_back(position[3 * i + 1]);
    out.z.push_back(position[3 * i + 2]);
    const float vx = velocity[3 * i], vy = velocity[3 * i + 1], vz = velocity[3 * i + 2];
    out.speed.push_back(std::sqrt(vx * vx + vy * vy + vz * vz));
  }
  for (const std::string& g : groups) {
    const std::vector<double> q = file.read_row<double>(g + "/pose/quaternion", number, 4);
    const std::vector<double> s = file.read_row<double>(g + "/pose/shift", number, 3);
    const std::uint8_t present = file.read_row<std::uint8_t>(g + "/pose/present", number, 1).at(0);
    out.parts.push_back({present != 0, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]}});
  }
  return out;
}

}  // namespace calx
