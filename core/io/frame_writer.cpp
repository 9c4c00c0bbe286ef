// Frames for ParaView: one .vtp of the spheres per frame, one .vtp per part and pose, and frames.pvd that lists them
// with their times. A part that does not move keeps its file, and the .pvd names it again.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "io/files.hpp"
#include "io/frame_columns.hpp"
#include "io/io.hpp"
#include "io/particles_h5.hpp"
#include "io/vtp.hpp"

namespace calx {
namespace {

namespace fs = std::filesystem;
constexpr char particles_stem[] = "particles";

std::string numbered(const std::string& stem, std::size_t number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "_%06zu.vtp", number);
  return "frames/" + stem + digits;
}

/// One <DataSet> line of the .pvd.
struct Entry {
  double time;
  std::string file, line;
};

std::string attribute_of(const std::string& line, const std::string& name) {
  const std::string key = " " + name + "=\"";
  const std::size_t start = line.find(key);
  if (start == std::string::npos) return "";
  const std::size_t from = start + key.size(), end = line.find('"', from);
  return end == std::string::npos ? "" : line.substr(from, end - from);
}

Entry make_entry(double time, std::size_t part, const std::string& name, const std::string& file) {
  return {time, file,
          "<DataSet timestep=\"" + shortest_text(time) + "\" group=\"\" part=\"" + std::to_string(part) + "\" name=\"" +
              xml_text(name) + "\" file=\"" + file + "\"/>"};
}

/// Entries of an existing .pvd up to the time given.
std::vector<Entry> read_entries(const std::string& path, double resume_at) {
  std::vector<Entry> out;
  const std::string text = read_text(path);
  for (std::size_t at = text.find("<DataSet"); at != std::string::npos; at = text.find("<DataSet", at + 1)) {
    const std::size_t end = text.find("/>", at);
    if (end == std::string::npos) break;
    Entry e{0, "", text.substr(at, end + 2 - at)};
    const std::string time = attribute_of(e.line, "timestep");
    e.file = attribute_of(e.line, "file");
    const auto parsed = std::from_chars(time.data(), time.data() + time.size(), e.time);
    if (parsed.ec != std::errc() || e.file.empty())
      throw Error(Fault::files, path + ": not a list of frames: " + e.line);
    if (e.time <= resume_at) out.push_back(e);
  }
  return out;
}

/// True for the names that this file gives: <stem>_<six or more digits>.vtp, finished or not.
bool is_frame_file(std::string name) {
  const auto drop = [&name](const std::string& end) {
    const bool has = name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
    if (has) name.resize(name.size() - end.size());
    return has;
  };
  drop(".partial");
  if (!drop(".vtp")) return false;
  const std::size_t digits = name.size() - (name.find_last_not_of("0123456789") + 1);
  return digits >= 6 && digits + 1 < name.size() && name[name.size() - digits - 1] == '_';
}

bool same_pose(const Pose& a, const Pose& b) {
  // Bits are meant: any motion at all is drawn.
  return a.turn.w == b.turn.w && a.turn.x == b.turn.x && a.turn.y == b.turn.y && a.turn.z == b.turn.z &&
         a.shift.x == b.shift.x && a.shift.y == b.shift.y && a.shift.z == b.shift.z;
}

void write_spheres(const std::string& path, const FrameColumns& f) {
  VtpFile file(f.time, std::vector<float>(f.position.begin(), f.position.end()));
  std::vector<float> diameter, speed;
  diameter.reserve(f.count());
  speed.reserve(f.count());
  for (std::size_t i = 0; i < f.count(); ++i) {
    diameter.push_back(2 * f.radius[i]);
    speed.push_back(static_cast<float>(norm(Vec3{f.velocity[3 * i], f.velocity[3 * i + 1], f.velocity[3 * i + 2]})));
  }
  file.set_vertices();
  file.point_data("radius", 1, f.radius);
  file.point_data("diameter", 1, diameter);
  file.point_data("clump", f.particle);
  file.point_data("velocity", 3, f.velocity);
  file.point_data("speed", 1, speed);
  file.point_data("material", f.material);
  file.point_data("contacts", f.contacts);
  file.write(path);
}

void write_part(const std::string& path, double time, const PartShape& shape, std::size_t number, const Pose& pose) {
  std::vector<float> points;
  points.reserve(shape.vertices.size());
  for (std::size_t k = 0; k + 2 < shape.vertices.size(); k += 3) {
    const Vec3 x = pose.to_world({shape.vertices[k], shape.vertices[k + 1], shape.vertices[k + 2]});
    for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(x[c]));
  }
  VtpFile file(time, std::move(points));
  file.set_triangles(shape.triangles);
  const std::size_t triangles = shape.triangles.size() / 3;
  file.cell_data("part", std::vector<std::uint32_t>(triangles, static_cast<std::uint32_t>(number)));
  file.cell_data("material", std::vector<std::uint32_t>(triangles, shape.material_index));
  file.write(path);
}

}  // namespace

struct FrameWriter::Impl {
  struct Drawn {
    Pose pose;
    std::string file;  // empty: not yet
  };
  std::string dir;
  std::size_t number = 0;
  std::vector<Entry> entries;
  std::vector<PartShape> shapes;
  std::vector<std::string> stems;
  std::vector<Drawn> drawn;
  std::unique_ptr<ParticlesH5> h5;

  std::string pvd() const { return dir + "/frames.pvd"; }

  void remove_unlisted() const {
    std::set<std::string> listed;
    for (const Entry& e : entries) listed.insert(e.file);
    for (const fs::directory_entry& file : fs::directory_iterator(dir + "/frames")) {
      const std::string name = file.path().filename().string();
      if (is_frame_file(name) && listed.count("frames/" + name) == 0) fs::remove(file.path());
    }
  }

  void write_list(const std::vector<Entry>& list) const {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<Collection>\n";
    for (const Entry& e : list) text += e.line + "\n";
    write_text_atomically(pvd(), text + "</Collection>\n</VTKFile>\n");
  }

  void find_shapes(const WorldView& world) {
    shapes = part_shapes(world);
    std::vector<std::string> names;
    for (const PartShape& s : shapes) names.push_back(s.name);
    stems = safe_names(names, particles_stem);
    drawn.assign(shapes.size(), {});
  }
};

FrameWriter::FrameWriter(const std::string& dir, bool particles_h5, double resume_at)
    : impl_(std::make_unique<Impl>()) {
  Impl& w = *impl_;
  w.dir = dir;
  make_folder(dir + "/frames");
  if (resume_at >= 0 && file_exists(w.pvd())) w.entries = read_entries(w.pvd(), resume_at);
  for (const Entry& e : w.entries) {
    const std::string start = std::string("frames/") + particles_stem + "_";
    std::size_t number = 0;
    if (e.file.compare(0, start.size(), start) != 0) continue;
    std::from_chars(e.file.data() + start.size(), e.file.data() + e.file.size(), number);
    w.number = std::max(w.number, number + 1);
  }
  // The list first, so that it never names a file that is gone.
  w.write_list(w.entries);
  w.remove_unlisted();
  if (particles_h5) w.h5 = std::make_unique<ParticlesH5>(dir + "/particles.h5", resume_at);
}

FrameWriter::~FrameWriter() = default;

void FrameWriter::write(const WorldView& world) {
  Impl& w = *impl_;
  if (w.shapes.size() != world.part_count()) w.find_shapes(world);
  const FrameColumns frame = frame_columns(world);
  std::vector<Entry> entries = w.entries;
  std::vector<Impl::Drawn> drawn = w.drawn;
  std::vector<std::string> written;
  try {
    const std::string name = numbered(particles_stem, w.number);
    written.push_back(w.dir + "/" + name);
    write_spheres(written.back(), frame);
    entries.push_back(make_entry(frame.time, 0, particles_stem, name));
    for (std::size_t k = 0; k < w.shapes.size(); ++k) {
      if (!world.part_present(k)) continue;
      const Pose pose = world.part_pose(k);
      if (drawn[k].file.empty() || !same_pose(drawn[k].pose, pose)) {
        drawn[k] = {pose, numbered(w.stems[k], w.number)};
        written.push_back(w.dir + "/" + drawn[k].file);
        write_part(written.back(), frame.time, w.shapes[k], k, pose);
      }
      entries.push_back(make_entry(frame.time, k + 1, w.shapes[k].name, drawn[k].file));
    }
    if (w.h5) w.h5->append(world, frame, w.shapes);
    w.write_list(entries);
  } catch (...) {
    for (const std::string& path : written) ::unlink(path.c_str());
    throw;
  }
  w.entries = std::move(entries);
  w.drawn = std::move(drawn);
  ++w.number;
}

}  // namespace calx
