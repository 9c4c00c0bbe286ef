#include "report/playback.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "report/json_text.hpp"
#include "report/units.hpp"

namespace calx {
namespace {

const std::uint32_t not_drawn = 0xffffffffu;

// Spheres of one particle keep their order, so (particle, n-th of it) names a sphere through all frames. Ids count up
// from 0, so plain arrays hold them.
struct Slots {
  std::vector<std::uint32_t> spheres;  // of each particle id; 0: never seen
  std::vector<std::uint32_t> first;    // slot of the particle's first sphere, or not_drawn
  std::size_t count = 0, seen_particles = 0, drawn_particles = 0;
};

struct Overview {
  Box box;
  float highest_speed = 0;
  std::size_t most_spheres = 0;
};

void count_spheres(const FrameData& frame, std::vector<std::uint32_t>& spheres) {
  for (std::uint32_t id : frame.particle) {
    if (id >= spheres.size()) spheres.resize(id + std::size_t{1}, 0);
    ++spheres[id];
  }
}

void look_at(const FrameData& frame, Slots& slots, Overview& seen) {
  std::vector<std::uint32_t> here;
  count_spheres(frame, here);
  if (here.size() > slots.spheres.size()) slots.spheres.resize(here.size(), 0);
  for (std::size_t id = 0; id < here.size(); ++id) slots.spheres[id] = std::max(slots.spheres[id], here[id]);
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    seen.box.add({frame.x[i], frame.y[i], frame.z[i]});
    seen.highest_speed = std::max(seen.highest_speed, frame.speed[i]);
  }
  seen.most_spheres = std::max(seen.most_spheres, frame.x.size());
}

void give_slots(Slots& slots, std::size_t most) {
  std::size_t total = 0;
  for (std::uint32_t count : slots.spheres) total += count;
  const std::size_t step = std::max<std::size_t>(1, (total + most - 1) / most);
  slots.first.assign(slots.spheres.size(), not_drawn);
  for (std::size_t id = 0; id < slots.spheres.size(); ++id) {
    if (slots.spheres[id] == 0 || slots.seen_particles++ % step != 0) continue;
    slots.first[id] = static_cast<std::uint32_t>(slots.count);
    slots.count += slots.spheres[id];
    ++slots.drawn_particles;
  }
}

std::uint16_t share(double value, double lo, double hi) {
  const double part = hi > lo ? (value - lo) / (hi - lo) : 0.5;
  return static_cast<std::uint16_t>(std::lround(65535 * std::min(1.0, std::max(0.0, part))));
}

std::string pack_frame(const FrameData& frame, const Slots& slots, const Overview& seen, std::vector<float>& radius) {
  std::vector<std::uint16_t> rows(4 * slots.count, 0);
  std::vector<std::uint32_t> next = slots.first;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    if (next[frame.particle[i]] == not_drawn) continue;
    const std::size_t slot = next[frame.particle[i]]++;
    std::uint16_t* row = &rows[4 * slot];
    row[0] = share(frame.x[i], seen.box.lo.x, seen.box.hi.x);
    row[1] = share(frame.y[i], seen.box.lo.y, seen.box.hi.y);
    row[2] = share(frame.z[i], seen.box.lo.z, seen.box.hi.z);
    const double fast = seen.highest_speed > 0 ? std::sqrt(std::max(0.0f, frame.speed[i] / seen.highest_speed)) : 0;
    row[3] = static_cast<std::uint16_t>(1 + std::lround(65534 * std::min(1.0, fast)));
    radius[slot] = frame.radius[i];
  }
  return base64(reinterpret_cast<const unsigned char*>(rows.data()), rows.size() * sizeof(std::uint16_t));
}

template <class T>
std::string base64_of(const std::vector<T>& v) {
  return base64(reinterpret_cast<const unsigned char*>(v.data()), v.size() * sizeof(T));
}

void write_parts(JsonText& out, const FrameSet& set) {
  out.key("parts").begin_array();
  for (const PartMesh& part : set.parts) {
    out.begin_object().member("name", part.name).member("material", part.material);
    out.member("vertices", base64_of(part.vertices)).member("triangles", base64_of(part.triangles)).end_object();
  }
  out.end_array();
}

void write_poses(JsonText& out, double time, const FrameData& frame) {
  out.begin_object().member("time", time).key("poses").begin_array();
  for (const FrameData::PartPose& p : frame.parts) {
    const std::vector<double> row = {p.turn.x, p.turn.y, p.turn.z, p.turn.w, p.shift.x, p.shift.y, p.shift.z};
    if (p.present) {
      out.values(row, 7);
    } else {
      out.value(false);
    }
  }
  out.end_array().end_object();
}

}  // namespace

std::string base64(const unsigned char* bytes, std::size_t count) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((count + 2) / 3 * 4);
  for (std::size_t i = 0; i < count; i += 3) {
    const std::uint32_t a = bytes[i], b = i + 1 < count ? bytes[i + 1] : 0u, c = i + 2 < count ? bytes[i + 2] : 0u;
    const std::uint32_t three = a << 16 | b << 8 | c;
    out += digits[three >> 18];
    out += digits[three >> 12 & 63];
    out += i + 1 < count ? digits[three >> 6 & 63] : '=';
    out += i + 2 < count ? digits[three & 63] : '=';
  }
  return out;
}

std::vector<std::size_t> spaced_frames(std::size_t count, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t n = std::min(count, std::max<std::size_t>(most, 1));
  for (std::size_t k = 0; k < n; ++k) {
    out.push_back(n == 1 ? count - 1 : (k * (count - 1) + (n - 1) / 2) / (n - 1));
  }
  return out;
}

Playback pack_playback(const RunFolder& run, const PlaybackLimits& limits) {
  Playback out;
  const std::size_t recorded = run.frames.times.size();
  // The last frame of a filling process holds the most spheres and so tells how many frames fit.
  const std::size_t guess =
      std::max<std::size_t>(1, std::min(limits.spheres, read_frame(run.dir, recorded - 1).x.size()));
  const std::size_t fit = std::max<std::size_t>(1, limits.bytes / (8 * guess));
  const std::size_t small_fit = std::min(limits.most_frames, limits.small_bytes / (8 * guess));
  out.chosen = spaced_frames(recorded, std::max(std::min(limits.frames, fit), small_fit));

  Slots slots;
  Overview seen;
  for (std::size_t number : out.chosen) look_at(read_frame(run.dir, number), slots, seen);
  give_slots(slots, limits.spheres);
  out.spheres = slots.count;
  out.recorded_spheres = seen.most_spheres;

  std::vector<float> radius(slots.count, 0);
  JsonText json;
  json.begin_object().key("frames").begin_array();
  for (std::size_t number : out.chosen) {
    const FrameData frame = read_frame(run.dir, number);
    out.frames += pack_frame(frame, slots, seen, radius) + "\n";
    write_poses(json, run.frames.times[number], frame);
  }
  json.end_array();
  if (slots.drawn_particles < slots.seen_particles) {
    out.note = format_count(static_cast<double>(slots.drawn_particles)) + " of " +
               format_count(static_cast<double>(slots.seen_particles)) + " particles are drawn, evenly chosen. ";
  }
  if (out.chosen.size() < recorded) {
    out.note +=
        std::to_string(out.chosen.size()) + " of " + std::to_string(recorded) + " recorded frames are embedded. ";
  }
  if (!out.note.empty()) out.note += "All of them are in particles.h5 and frames.pvd.";
  const Box box = seen.most_spheres > 0 ? seen.box : Box{{0, 0, 0}, {0, 0, 0}};
  json.key("lo").values({box.lo.x, box.lo.y, box.lo.z}, 9).key("hi").values({box.hi.x, box.hi.y, box.hi.z}, 9);
  json.key("up").values({-run.gravity.x, -run.gravity.y, -run.gravity.z});
  json.member("spheres", static_cast<double>(slots.count))
      .member("highestSpeed", static_cast<double>(seen.highest_speed));
  json.member("everyFrame", out.chosen.size() == recorded);
  json.member("radii", base64_of(radius));
  json.key("events").begin_array();
  for (const NamedValue& e : run.events)
    json.begin_object().member("name", e.name).member("time", e.value).end_object();
  json.end_array();
  write_parts(json, run.frames);
  json.end_object();
  out.json = json.text();
  return out;
}

}  // namespace calx
