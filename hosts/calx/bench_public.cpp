// bench_public.cpp: cases others have published figures for: penetration (B4) and drum (B5) of Dosta et al. (2024,
// Comput. Phys. Commun. 296, 109066), chute (B7) as the granular bench of LAMMPS.
//
// Beds of stiff grains are settled in two stages that take far fewer steps: with soft and slightly larger grains, then
// with grains of the real size, ten times softer than the real ones, which close the gaps.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/units.hpp"
#include "bench_scene.hpp"

namespace calx {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kGrown = 1.02;  // diameter while settling over the real one: more than the overlaps then
struct Stage {
  double young, step, share;  // Pa; s; of the settling time
};
constexpr Stage kGrow{1e7, 1.7e-5, 1}, kClose{1e8, 5.4e-6, 0.12};

long long wanted(const BenchOptions& o, long long usual) { return o.particles > 0 ? o.particles : usual; }
double settle_time(const BenchOptions& o, double usual) { return o.settle >= 0 ? o.settle : usual; }

/// young: of all, Pa; 0: their own.
std::string dosta_materials(double young) {
  return R"({"M1": )" + bench_material(2500, young > 0 ? young : 1e9, 0.2) + R"(, "M2": )" +
         bench_material(2000, young > 0 ? young : 0.5e9, 0.2) + R"(, "steel": )" +
         bench_material(7200, young > 0 ? young : 210e9, 0.2) + "}";
}

std::string dosta_contacts(double rolling) {
  struct Pair {
    const char *a, *b;
    double restitution, friction;
  };
  const Pair pairs[] = {{"M1", "M1", 0.5, 0.3},    {"M2", "M2", 0.4, 0.4},    {"M1", "M2", 0.45, 0.2},
                        {"M1", "steel", 0.4, 0.2}, {"M2", "steel", 0.4, 0.2}, {"steel", "steel", 0.6, 0.5}};
  std::string text;
  for (const Pair& p : pairs)
    text += (text.empty() ? "" : ",\n    ") + bench_contact(p.a, p.b, p.restitution, p.friction, rolling);
  return text;
}

void scale_seeds(std::vector<Seed>& seeds, double factor) {
  for (Seed& s : seeds) s.scale *= factor;
}

void settle_stiff(BenchScene& s, double seconds, const BenchOptions& o) {
  for (const Stage& stage : {kGrow, kClose}) {
    const double grown = stage.young == kGrow.young ? kGrown : 1;
    s.materials = dosta_materials(stage.young);
    s.step = stage.step;
    for (auto& source : s.sources) scale_seeds(source.seeds, grown);
    settle(s, stage.share * seconds, o);
    for (auto& source : s.sources) scale_seeds(source.seeds, 1 / grown);
  }
}

void facet(std::ofstream& out, const Vec3& a, const Vec3& b, const Vec3& c) {
  out << "facet normal 0 0 0\nouter loop\n";
  for (const Vec3& v : {a, b, c}) out << "vertex " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  out << "endloop\nendfacet\n";
}

/// A tube about y from -half to half, closed: 200 facets round it, 1200 triangles.
void write_drum(const std::string& path, double radius, double half) {
  constexpr int kFacets = 200, kRings = 2;
  std::ofstream out(path);
  out.precision(12);
  out << "solid drum\n";
  auto at = [&](int k, double y) {
    const double a = 2 * kPi * (k % kFacets) / kFacets;
    return Vec3{radius * std::sin(a), y, radius * std::cos(a)};
  };
  for (int k = 0; k < kFacets; ++k) {
    for (int ring = 0; ring < kRings; ++ring) {
      const double y0 = -half + 2 * half * ring / kRings, y1 = -half + 2 * half * (ring + 1) / kRings;
      facet(out, at(k, y0), at(k + 1, y0), at(k + 1, y1));
      facet(out, at(k, y0), at(k + 1, y1), at(k, y1));
    }
    facet(out, {0, -half, 0}, at(k + 1, -half), at(k, -half));
    facet(out, {0, half, 0}, at(k, half), at(k + 1, half));
  }
  out << "endsolid drum\n";
  out.close();
  if (!out) throw Error(Fault::files, path + ": cannot be written");
}

/// Pyramids on a square grid, their feet at z = 0, over the footprint and two more of them all round.
void write_bumps(const std::string& path, long long nx, long long ny, double lx, double ly, double height) {
  std::ofstream out(path);
  out.precision(12);
  out << "solid base\n";
  const double px = lx / static_cast<double>(nx), py = ly / static_cast<double>(ny);
  for (long long a = -2; a < nx + 2; ++a)
    for (long long b = -2; b < ny + 2; ++b) {
      const auto x = static_cast<double>(a) * px, y = static_cast<double>(b) * py, x1 = static_cast<double>(a + 1) * px,
                 y1 = static_cast<double>(b + 1) * py;
      const Vec3 top{x + 0.5 * px, y + 0.5 * py, height};
      facet(out, {x, y, 0}, {x1, y, 0}, top);
      facet(out, {x1, y, 0}, {x1, y1, 0}, top);
      facet(out, {x1, y1, 0}, {x, y1, 0}, top);
      facet(out, {x, y1, 0}, {x, y, 0}, top);
    }
  out << "endsolid base\n";
  out.close();
  if (!out) throw Error(Fault::files, path + ": cannot be written");
}

}  // namespace

BenchScene penetration_scene(const BenchOptions& o) {
  const long long count = wanted(o, 25000);
  // The footprint is that of the 25 000 and more; fewer lie as deep in a smaller box.
  const double shrink = std::min(1.0, std::cbrt(static_cast<double>(count) / 25000)), hx = 0.049 * shrink,
               hy = 0.030 * shrink, floor = -0.0902431, d = 2e-3;
  BenchScene s;
  s.lo = {-hx - 0.01, -hy - 0.01, floor - 0.01};
  s.hi = {hx + 0.01, hy + 0.01, 2};
  s.contacts = dosta_contacts(o.rolling);
  s.shapes = R"({"grain": {"sphere": {"radius": 0.001}}, "ball": {"sphere": {"radius": )" +
             format_number(0.01 * shrink) + "}}}";
  s.parts = R"({"name": "box", "geometry": "calx.box", "material": "steel", "parameters": {"min": [)" +
            format_number(-hx) + ", " + format_number(-hy) + ", " + format_number(floor) + R"(], "max": [)" +
            format_number(hx) + ", " + format_number(hy) + R"(, 1.9], "open_top": "yes"}})";
  s.sources = {{"bed", "grain", "M1", {}}};
  auto& bed = s.sources[0].seeds;
  if (!o.start.empty()) {
    bed = read_seeds(o.start);
  } else {
    bed = bench_lattice(count, 2 * hx, 2 * hy, 1.15 * d, 0.06 * d, 12);
    for (Seed& seed : bed) seed.x += Vec3{-hx, -hy, floor};
    settle_stiff(s, settle_time(o, 0.25), o);
  }
  if (!o.save.empty()) write_seeds(o.save, bed);
  double top = floor;
  for (const Seed& seed : bed) top = std::max(top, seed.x.z + 0.5 * d);
  Seed ball;
  ball.x = {0, 0, std::max(0.06, top + 0.015)};
  ball.v = {0, 0, -5};
  s.sources.push_back({"ball", "ball", "steel", {ball}});
  s.materials = dosta_materials(0);
  s.step = 5e-7;
  s.physics = scene_physics(o.name);
  return s;
}

BenchScene drum_scene(const BenchOptions& o, const std::string& folder) {
  const auto count = static_cast<double>(wanted(o, 38000));
  // More particles lie in a longer drum, fewer in a smaller one of the same shape.
  const double shrink = std::min(1.0, std::cbrt(count / 38000)), radius = 0.1 * shrink,
               half = 0.03 * (count > 38000 ? count / 38000 : shrink), omega = 2;
  const auto coarse = static_cast<std::size_t>(std::llround(count * 8 / 38));
  write_drum(folder + "/drum.stl", radius, half);
  BenchScene s;
  s.lo = {-radius - 0.01, -half - 0.01, -radius - 0.01};
  s.hi = {radius + 0.01, half + 0.01, radius + 0.01};
  s.contacts = dosta_contacts(o.rolling);
  s.shapes = R"({"fine": {"sphere": {"radius": 0.001}}, "coarse": {"sphere": {"radius": 0.002}}})";
  auto part = [&](const std::string& motion) {
    return R"({"name": "drum", "geometry": "calx.mesh", "material": "steel", )" + motion +
           R"("parameters": {"file": ")" + std::filesystem::absolute(folder + "/drum.stl").string() +
           R"(", "unit": "m"}})";
  };
  s.parts = part("");
  s.sources = {{"coarse", "coarse", "M2", {}}, {"fine", "fine", "M1", {}}};
  std::vector<double> radii(static_cast<std::size_t>(count), kGrown * 1e-3);
  std::fill_n(radii.begin(), coarse, kGrown * 2e-3);
  RegionSettings room;
  room.kind = RegionSettings::Kind::cylinder;
  const double wall = 1.1 * radii.front();
  room.a = {0, -half + wall, 0};
  room.b = {0, half - wall, 0};
  room.radius = radius - wall;
  const std::vector<Vec3> places = scatter(radii, room, 13);
  for (std::size_t k = 0; k < places.size(); ++k) {
    Seed seed;
    seed.x = places[k];
    s.sources[k < coarse ? 0 : 1].seeds.push_back(seed);
  }
  settle_stiff(s, settle_time(o, 0.3), o);
  s.materials = dosta_materials(0);
  s.step = 8e-7;
  s.parts = part(R"("motion": "turn", )");
  s.motions =
      R"({"turn": {"plugin": "calx.motion-table", "parameters": {"axis": [0, 1, 0], "cycles": 0, "rows": [[0, 0, 0], [1, )" +
      format_number(omega) + ", 0]]}}}";
  s.physics = scene_physics(o.name);
  return s;
}

// Units of mass and diameter 1 kg and 1 m, gravity 1 m/s2 at 26 degrees: the figures of LAMMPS' bench as they stand.
BenchScene chute_scene(const BenchOptions& o, const std::string& folder) {
  if (o.base != "bumps" && o.base != "plane")
    throw Error(Fault::usage, "bench: --base " + o.base + ": a chute stands on \"bumps\" or on a \"plane\"");
  const auto count = static_cast<double>(wanted(o, 32000));
  // 40 layers on a footprint twice as long as wide; fewer layers where it would become narrower than four grains.
  const double pitch = 1.06, layers = 40;
  const auto ny = std::max<long long>(4, std::llround(std::sqrt(count / layers / 2))), nx = 2 * ny;
  const double lx = static_cast<double>(nx) * pitch, ly = static_cast<double>(ny) * pitch, slope = 26 * kPi / 180;
  BenchScene s;
  s.gravity = {std::sin(slope), 0, -std::cos(slope)};
  s.lo = {0, 0, -3};
  s.hi = {lx, ly, count / static_cast<double>(nx * ny) * pitch + 20};
  s.periodic = "[true, true, false]";
  s.step = 1e-4;
  s.materials = R"({"grain": {"density": )" + format_number(6 / kPi) + "}}";
  s.contacts = R"({"between": ["grain", "grain"], "law": "calx.linear", "parameters": {"kn": 200000, "restitution": 1,
      "damping_rate": 50, "tangential_damping": 0, "friction": 0.5)";
  if (o.rolling > 0) s.contacts += R"(, "rolling": "epsd2", "rolling_friction": )" + format_number(o.rolling);
  s.contacts += "}}";
  s.shapes = R"({"grain": {"sphere": {"radius": 0.5}}})";
  if (o.base == "plane") {
    s.parts = R"({"name": "base", "geometry": "calx.plane", "material": "grain", "parameters": {"point": [)" +
              format_number(0.5 * lx) + ", " + format_number(0.5 * ly) + R"(, 0], "half_u": )" +
              format_number(0.5 * lx + 2) + R"(, "half_v": )" + format_number(0.5 * ly + 2) + "}}";
  } else {
    write_bumps(folder + "/base.stl", nx, ny, lx, ly, 0.4);
    s.parts = R"({"name": "base", "geometry": "calx.mesh", "material": "grain", "parameters": {"file": ")" +
              std::filesystem::absolute(folder + "/base.stl").string() + R"(", "unit": "m", "allow_open": "yes"}})";
  }
  s.sources = {{"grains", "grain", "grain", bench_lattice(wanted(o, 32000), lx, ly, pitch, 0.02, 14)}};
  for (Seed& seed : s.sources[0].seeds) seed.x.z += o.base == "plane" ? 0.01 : 0.41;
  if (o.start.empty()) settle(s, settle_time(o, 4), o);
  if (!o.save.empty()) write_seeds(o.save, s.sources[0].seeds);
  s.physics = scene_physics(o.name);
  return s;
}

}  // namespace calx
