#include "io/particles_h5.hpp"

#include <unistd.h>

#include <algorithm>

#include "io/creator.hpp"
#include "io/files.hpp"
#include "io/h5_file.hpp"

namespace calx {
namespace {

const std::string spheres = "particles/spheres/";
const std::string shared_step = spheres + "position/step", shared_time = spheres + "position/time";

struct Quantity {
  const char* name;
  H5Type type;
  bool vector;
  const char* unit;
};
constexpr Quantity quantities[] = {
    {"position", H5Type::f64, true, "m"}, {"velocity", H5Type::f32, true, "m s-1"},
    {"radius", H5Type::f32, false, "m"},  {"id", H5Type::u32, false, ""},
    {"particle", H5Type::u32, false, ""}, {"material", H5Type::u32, false, ""},
    {"contacts", H5Type::u32, false, ""},
};

std::string value_of(const std::string& name) { return spheres + name + "/value"; }

const void* data_of(const FrameColumns& f, const std::string& name) {
  if (name == "position") return f.position.data();
  if (name == "velocity") return f.velocity.data();
  if (name == "radius") return f.radius.data();
  if (name == "id") return f.sphere.data();
  if (name == "particle") return f.particle.data();
  if (name == "material") return f.material.data();
  return f.contacts.data();
}

std::vector<std::string> groups_of(const std::vector<PartShape>& parts) {
  std::vector<std::string> names;
  for (const PartShape& p : parts) names.push_back(p.name);
  names = safe_names(names, "");
  for (std::string& n : names) n = "parts/" + n;
  return names;
}

}  // namespace

std::vector<std::string> growing_datasets(const std::vector<std::string>& part_groups) {
  std::vector<std::string> out{shared_step, shared_time, value_of("count")};
  for (const Quantity& q : quantities) out.push_back(value_of(q.name));
  for (const std::string& g : part_groups) {
    for (const char* name : {"/pose/quaternion", "/pose/shift", "/pose/present"}) out.push_back(g + name);
  }
  return out;
}

ParticlesH5::ParticlesH5(const std::string& path, double resume_at) : path_(path) {
  if (!file_exists(path)) return;
  if (resume_at < 0) {
    if (::unlink(path.c_str()) != 0) throw_file_error("replace", path, errno);
    ::unlink((path + ".journal").c_str());
    return;
  }
  H5File file(path, H5File::Mode::update);
  const std::vector<double> times = file.read<double>(shared_time);
  const auto later = std::find_if(times.begin(), times.end(), [=](double t) { return t > resume_at; });
  std::vector<std::string> groups;
  for (const std::string& name : file.members("parts")) groups.push_back("parts/" + name);
  for (const std::string& name : growing_datasets(groups)) {
    file.truncate(name, static_cast<std::uint64_t>(later - times.begin()));
  }
  file.commit(false);
}

void ParticlesH5::create(const WorldView& world, const std::vector<PartShape>& parts) const {
  const CaseSettings& settings = world.settings();
  const std::string partial = path_ + ".partial";
  {
    H5File file(partial, H5File::Mode::create, path_);
    file.set_counts("h5md", "version", {1, 1});
    file.set_text("h5md/creator", "name", creator_name);
    file.set_text("h5md/creator", "version", creator_version);
    file.set_text("h5md/author", "name", settings.title.empty() ? creator_name : settings.title);

    file.create_growing(shared_step, H5Type::u64, {}, false, "");
    file.create_growing(shared_time, H5Type::f64, {}, false, "s");
    const auto link_clock = [&file](const std::string& group) {
      file.link(shared_step, group + "/step");
      file.link(shared_time, group + "/time");
    };
    for (const Quantity& q : quantities) {
      file.create_growing(value_of(q.name), q.type, q.vector ? H5File::Sizes{0, 3} : H5File::Sizes{0}, true, q.unit);
      if (std::string(q.name) != "position") link_clock(spheres + q.name);
    }
    file.create_growing(value_of("count"), H5Type::u64, {}, false, "");
    link_clock(spheres + "count");
    std::vector<std::string> materials;
    for (const MaterialSettings& m : settings.materials) materials.push_back(m.name);
    file.set_texts(spheres + "material", "names", materials);

    const Vec3 lo = settings.domain.box.lo, size = settings.domain.box.hi - lo;
    const double edges[] = {size.x, size.y, size.z}, origin[] = {lo.x, lo.y, lo.z};
    file.write(spheres + "box/edges", H5Type::f64, edges, {3}, "m");
    file.write(spheres + "box/origin", H5Type::f64, origin, {3}, "m");
    file.set_counts(spheres + "box", "dimension", {3});
    std::vector<std::string> boundary;
    for (const bool periodic : settings.domain.periodic) boundary.push_back(periodic ? "periodic" : "none");
    file.set_texts(spheres + "box", "boundary", boundary);

    const std::vector<std::string> groups = groups_of(parts);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const PartShape& p = parts[k];
      const std::string& g = groups[k];
      file.write(g + "/vertices", H5Type::f32, p.vertices.data(), {p.vertices.size() / 3, 3}, "m");
      file.write(g + "/triangles", H5Type::u32, p.triangles.data(), {p.triangles.size() / 3, 3});
      file.set_text(g, "name", p.name);
      file.set_text(g, "geometry", p.geometry);
      file.set_text(g, "material", p.material);
      file.set_counts(g, "index", {k});
      file.create_growing(g + "/pose/quaternion", H5Type::f64, {4}, false, "");
      file.create_growing(g + "/pose/shift", H5Type::f64, {3}, false, "m");
      file.create_growing(g + "/pose/present", H5Type::u8, {}, false, "");
      link_clock(g + "/pose");
    }
    file.commit(false);
  }
  rename_file(partial, path_);
}

void ParticlesH5::append(const WorldView& world, const FrameColumns& frame, const std::vector<PartShape>& parts) {
  if (!file_exists(path_)) create(world, parts);
  H5File file(path_, H5File::Mode::update);
  const std::uint64_t count = frame.count();
  for (const Quantity& q : quantities) {
    file.append(value_of(q.name), q.type, data_of(frame, q.name),
                q.vector ? H5File::Sizes{count, 3} : H5File::Sizes{count});
  }
  const std::vector<std::string> groups = groups_of(parts);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const Pose pose = world.part_pose(k);
    const double turn[] = {pose.turn.w, pose.turn.x, pose.turn.y, pose.turn.z};
    const double shift[] = {pose.shift.x, pose.shift.y, pose.shift.z};
    const std::uint8_t present = world.part_present(k) ? 1 : 0;
    file.append(groups[k] + "/pose/quaternion", H5Type::f64, turn, {4});
    file.append(groups[k] + "/pose/shift", H5Type::f64, shift, {3});
    file.append(groups[k] + "/pose/present", H5Type::u8, &present, {});
  }
  file.append(value_of("count"), H5Type::u64, &count, {});
  file.append(shared_step, H5Type::u64, &frame.step, {});
  file.append(shared_time, H5Type::f64, &frame.time, {});
  file.commit(false);
}

}  // namespace calx
