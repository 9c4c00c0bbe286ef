// fake_world.hpp: a world made by hand for tests of sensors: every figure a sensor may read is a public member.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "measure/measure.hpp"

namespace calx {

class FakeWorld : public WorldView {
 public:
  static constexpr double pi = 3.14159265358979323846;

  CaseSettings case_settings;
  Particles grains;
  double now = 0, dt = 1e-4;
  std::uint64_t steps = 0;
  std::vector<Pose> poses;      // one per part
  std::vector<PartLoad> loads;  // one per part
  std::vector<bool> present;    // one per part
  std::vector<ContactRow> rows;
  EnergyLedger energies;
  MassLedger masses;
  std::map<std::string, double> cycles, events;

  FakeWorld() {
    case_settings.file = "case.json";
    case_settings.domain.box = {{-10, -10, -10}, {10, 10, 10}};
    grains.density = {1000};
    grains.first_sphere = {0};
  }

  RegionSettings& add_box(const std::string& name, const Vec3& lo, const Vec3& hi) {
    RegionSettings region;
    region.name = name;
    region.a = lo, region.b = hi;
    case_settings.regions.push_back(region);
    return case_settings.regions.back();
  }
  RegionSettings& add_cylinder(const std::string& name, const Vec3& a, const Vec3& b, double radius) {
    RegionSettings& region = add_box(name, a, b);
    region.kind = RegionSettings::Kind::cylinder;
    region.radius = radius;
    return region;
  }
  void add_part(const std::string& name) {
    PartSettings part;
    part.name = name;
    case_settings.parts.push_back(part);
    poses.emplace_back();
    loads.emplace_back();
    present.push_back(true);
  }
  void add_motion(const std::string& name, const std::string& start) {
    MotionSettings motion;
    motion.name = name, motion.start = start;
    case_settings.motions.push_back(motion);
  }

  /// One sphere of density 1000 kg/m^3; its rank.
  std::size_t add_sphere(const Vec3& at, double radius, const Vec3& velocity = {}) {
    Shape shape;
    shape.members = {{{}, 1}};
    shape.volume = 4 * pi / 3;
    shape.equal_radius = shape.bound = 1;
    return add(shape, {{at, radius}}, at, radius, velocity);
  }
  /// Two touching spheres, one above the other, centre of mass at the point given.
  std::size_t add_dumbbell(const Vec3& at, double radius, const Vec3& velocity = {}) {
    Shape shape;
    shape.members = {{{0, 0, -1}, 1}, {{0, 0, 1}, 1}};
    shape.volume = 8 * pi / 3;
    shape.bound = 2;
    shape.equal_radius = 1.2599210498948732;
    const Vec3 arm{0, 0, radius};
    return add(shape, {{at - arm, radius}, {at + arm, radius}}, at, radius, velocity);
  }
  void move(std::size_t rank, const Vec3& by) {
    const auto shift = [&](Record& r) { r.x += by.x, r.y += by.y, r.z += by.z; };
    shift(grains.body[rank]);
    for (std::uint32_t s = grains.first_sphere[rank]; grains.has_clumps && s < grains.first_sphere[rank + 1]; ++s)
      shift(grains.member[s]);
  }
  /// Takes away a world of single spheres' particle, as a domain's end does.
  void erase(std::size_t rank) {
    const auto at = static_cast<std::ptrdiff_t>(rank);
    grains.body.erase(grains.body.begin() + at);
    grains.id.erase(grains.id.begin() + at);
    grains.shape.erase(grains.shape.begin() + at);
    grains.material.erase(grains.material.begin() + at);
    grains.scale.erase(grains.scale.begin() + at);
    grains.first_sphere.pop_back();
  }
  void swap_ranks(std::size_t a, std::size_t b) {
    std::swap(grains.body[a], grains.body[b]);
    std::swap(grains.id[a], grains.id[b]);
  }
  void touch(std::uint32_t i, std::uint32_t j, const Vec3& normal, double overlap = 0) {
    rows.push_back({i, j, -1, overlap, normal});
  }
  void touch_part(std::uint32_t i, int part, const Vec3& normal, double overlap = 0) {
    rows.push_back({i, 0, part, overlap, normal});
  }

  std::unique_ptr<Sensor> sensor(const std::string& json_text, const std::string& kind) const {
    return make_sensor(settings_of(json_text, kind), case_settings);
  }
  static SensorSettings settings_of(const std::string& json_text, const std::string& kind) {
    SensorSettings settings;
    settings.name = "probe", settings.kind = kind, settings.pointer = "/sensors/0", settings.every = 0.01;
    settings.parameters.json = json_text, settings.parameters.pointer = settings.pointer;
    return settings;
  }
  /// The message of the error that making this sensor ends with; empty when there is none.
  std::string error_of(const std::string& json_text, const std::string& kind) const {
    try {
      sensor(json_text, kind);
    } catch (const Error& e) {
      return e.fault() == Fault::settings ? e.what() : "wrong fault";
    }
    return {};
  }

  const CaseSettings& settings() const override { return case_settings; }
  double time() const override { return now; }
  std::uint64_t step() const override { return steps; }
  double time_step() const override { return dt; }
  const Particles& particles() const override { return grains; }
  std::size_t part_count() const override { return poses.size(); }
  const std::string& part_name(std::size_t part) const override { return case_settings.parts[part].name; }
  bool part_present(std::size_t part) const override { return present[part]; }
  const Surface& part_surface(std::size_t) const override { throw Error(Fault::usage, "no surfaces here"); }
  Pose part_pose(std::size_t part) const override { return poses[part]; }
  PartLoad part_load(std::size_t part) const override { return loads[part]; }
  std::vector<ContactRow> contacts() const override { return rows; }
  std::vector<std::uint32_t> contact_counts() const override { return {}; }
  EnergyLedger energy() const override { return energies; }
  MassLedger mass() const override { return masses; }
  double cycles_of(const std::string& motion) const override {
    const auto it = cycles.find(motion);
    return it == cycles.end() ? 0 : it->second;
  }
  double event_time(const std::string& event) const override {
    const auto it = events.find(event);
    return it == events.end() ? -1 : it->second;
  }
  bool in_region(const std::string& name, const Vec3& p) const override {
    for (const RegionSettings& region : case_settings.regions)
      if (region.name == name) {
        if (region.follows.empty()) return region.contains(p);
        for (std::size_t k = 0; k < poses.size(); ++k)
          if (part_name(k) == region.follows) return region.contains(poses[k].to_part(p));
      }
    return false;
  }

 private:
  std::size_t add(const Shape& shape, const std::vector<std::pair<Vec3, double>>& spheres, const Vec3& at, double scale,
                  const Vec3& velocity) {
    grains.shapes.push_back(shape);
    const std::uint32_t rank = static_cast<std::uint32_t>(grains.count());
    Record body{at.x, at.y, at.z, shape.bound * scale, velocity.x, velocity.y, velocity.z, 0, 0, 0, 0, 0};
    body.m = 1000 * shape.volume * scale * scale * scale;
    grains.body.push_back(body);
    grains.id.push_back(grains.next_id++);
    grains.shape.push_back(static_cast<std::uint32_t>(grains.shapes.size() - 1));
    grains.material.push_back(0);
    grains.scale.push_back(scale);
    grains.first_sphere.push_back(grains.first_sphere.back() + static_cast<std::uint32_t>(spheres.size()));
    grains.has_clumps = grains.has_clumps || spheres.size() > 1;
    for (const auto& sphere : spheres) {
      Record member = body;
      member.x = sphere.first.x, member.y = sphere.first.y, member.z = sphere.first.z, member.r = sphere.second;
      grains.member.push_back(member);
      grains.owner.push_back(rank);
    }
    return rank;
  }
};

}  // namespace calx
