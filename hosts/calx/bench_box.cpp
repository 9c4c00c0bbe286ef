// bench_box.cpp: beds in a box of the material of the particles: settled (B1), pour (B2), sizes (B3), clumps (B9).
//
// Spheres of 2.5 mm, 2100 kg/m3, E = 1e7 Pa, nu = 0.25, restitution 0.3, friction 0.5; the step is 10 % of the Rayleigh
// time. A tile of at most 10 000 particles is poured and settled once, then repeated side by side.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/units.hpp"
#include "bench_scene.hpp"

namespace calx {
namespace {

constexpr double kDiameter = 2.5e-3, kDensity = 2100;
constexpr double kTile = 0.05;  // m, side of the tile of 10 000 spheres
constexpr long long kTileCount = 10000;
constexpr double kStep = 9.8e-6, kSettleStep = 1.96e-5, kSettleTime = 0.25;  // s

long long wanted(const BenchOptions& o, long long usual) { return o.particles > 0 ? o.particles : usual; }
double settle_time(const BenchOptions& o, double usual) { return o.settle >= 0 ? o.settle : usual; }

void put_in_box(BenchScene& s, double lx, double ly) {
  s.lo = {-0.01, -0.01, -0.01};
  s.hi = {lx + 0.01, ly + 0.01, 2};
  s.parts = R"({"name": "box", "geometry": "calx.box", "material": "sand", "parameters": {"min": [0, 0, 0], "max": [)" +
            format_number(lx) + ", " + format_number(ly) + R"(, 1.9], "open_top": "yes"}})";
}

BenchScene box_scene(const BenchOptions& o, double lx, double ly, double rolling) {
  BenchScene s;
  put_in_box(s, lx, ly);
  s.step = kStep;
  s.materials = R"({"sand": )" + bench_material(kDensity, 1e7, 0.25) + "}";
  s.contacts = bench_contact("sand", "sand", 0.3, 0.5, rolling);
  s.shapes = R"({"ball": {"sphere": {"radius": 0.00125}}})";
  s.sources = {{"bed", "ball", "sand", {}}};
  s.physics = scene_physics(o.name);
  return s;
}

/// A tile of the shape and sizes of the scene, settled or read; lx, ly: its footprint.
void settle_tile(BenchScene& s, const BenchOptions& o) {
  auto& seeds = s.sources[0].seeds;
  if (!o.start.empty()) {
    seeds = read_seeds(o.start);
    if (seeds.empty()) throw Error(Fault::files, o.start + ": holds no particles");
  } else {
    settle(s, settle_time(o, kSettleTime), o);
  }
  if (!o.save.empty()) write_seeds(o.save, seeds);
}

BenchScene settled_bed(const BenchOptions& o) {
  const long long count = std::min(wanted(o, 100000), kTileCount);
  double lx = kTile * std::cbrt(static_cast<double>(count) / static_cast<double>(kTileCount)), ly = lx;
  if (!o.start.empty()) lx = ly = kTile;
  // The start is the same with and without rolling resistance.
  BenchScene tile = box_scene(o, lx, ly, 0);
  tile.step = kSettleStep;
  tile.sources[0].seeds = bench_lattice(count, lx, ly, 1.15 * kDiameter, 0.06 * kDiameter, 7);
  settle_tile(tile, o);
  BenchScene s = box_scene(o, lx, ly, o.rolling);
  s.sources[0].seeds = tiled(tile.sources[0].seeds, wanted(o, 100000), lx, ly);
  put_in_box(s, lx, ly);
  return s;
}

}  // namespace

BenchScene settled_scene(const BenchOptions& o) { return settled_bed(o); }

// The upper half of the bed is taken off and falls back as a jittered lattice at 1.5 m/s.
BenchScene pour_scene(const BenchOptions& o) {
  BenchScene s = settled_bed(o);
  const std::vector<Seed> bed = std::move(s.sources[0].seeds);
  const double lx = s.hi.x - 0.01, ly = s.hi.y - 0.01;
  double top = 0;
  for (const auto& b : bed) top = std::max(top, b.x.z);
  auto& out = s.sources[0].seeds;
  out.clear();
  for (const auto& b : bed)
    if (b.x.z < 0.5 * top) out.push_back(b);
  for (Seed f :
       bench_lattice(static_cast<long long>(bed.size() - out.size()), lx, ly, 1.15 * kDiameter, 0.06 * kDiameter, 8)) {
    f.x.z += 0.5 * top + 1.5 * kDiameter;
    f.v = {0, 0, -1.5};
    out.push_back(f);
  }
  return s;
}

// Five diameters from 1 to 5 mm, equal shares of the volume.
BenchScene sizes_scene(const BenchOptions& o) {
  constexpr std::array<double, 5> kScales{2, 1.4, 1, 0.6, 0.4};
  const long long count = std::min(wanted(o, 100000), kTileCount);
  double weights = 0, volume = 0;
  for (const double scale : kScales) weights += 1 / (scale * scale * scale);
  std::vector<double> radii;
  for (const double scale : kScales) {
    const auto n =
        scale == kScales.back()
            ? count - static_cast<long long>(radii.size())
            : std::max<long long>(1, std::llround(static_cast<double>(count) / (scale * scale * scale) / weights));
    for (long long k = 0; k < n; ++k) radii.push_back(0.5 * scale * kDiameter);
  }
  for (const double r : radii) volume += 4.0 / 3.0 * 3.141592653589793 * r * r * r;
  double lx = std::cbrt(volume / 0.6), ly = lx;

  BenchScene tile = box_scene(o, lx, ly, 0);
  tile.step = 7e-6;
  RegionSettings room;
  room.a = {radii[0], radii[0], radii[0]};
  room.b = {lx - radii[0], ly - radii[0], radii[0] + volume / (0.2 * (lx - 2 * radii[0]) * (ly - 2 * radii[0]))};
  if (o.start.empty()) {
    const std::vector<Vec3> places = scatter(radii, room, 9);
    for (std::size_t k = 0; k < places.size(); ++k) {
      Seed seed;
      seed.x = places[k];
      seed.scale = 2 * radii[k] / kDiameter;
      tile.sources[0].seeds.push_back(seed);
    }
  }
  settle_tile(tile, o);
  BenchScene s = box_scene(o, lx, ly, o.rolling);
  s.step = 3.5e-6;
  s.sources[0].seeds = tiled(tile.sources[0].seeds, wanted(o, 100000), lx, ly);
  put_in_box(s, lx, ly);
  return s;
}

// Two spheres of 2.5 mm, 0.625 mm apart: aspect ratio 1.25.
BenchScene clumps_scene(const BenchOptions& o) {
  if (o.law != "calx.epam" && o.law != "calx.hertz-mindlin")
    throw Error(Fault::usage, "bench: --law " + o.law + ": clumps run with \"calx.epam\" or \"calx.hertz-mindlin\"");
  const long long count = std::min(wanted(o, 100000), kTileCount);
  double lx = kTile * std::cbrt(static_cast<double>(count) / static_cast<double>(kTileCount)), ly = lx;
  if (!o.start.empty()) lx = ly = kTile;
  auto scene = [&](double rolling) {
    BenchScene s = box_scene(o, lx, ly, rolling);
    if (o.law == "calx.epam") {
      s.contacts = R"({"between": ["sand", "sand"], "law": "calx.epam", "parameters": {"exponent": "1.5",
        "restitution": 0.3, "friction": 0.5, "plasticity": 0.4, "surface_energy": 0.1)";
      if (rolling > 0) s.contacts += R"(, "rolling": "epsd", "rolling_friction": )" + format_number(rolling);
      s.contacts += "}}";
    }
    s.shapes = R"({"grain": {"spheres": [{"at": [0, 0, -0.0003125], "radius": 0.00125},
                                         {"at": [0, 0, 0.0003125], "radius": 0.00125}]}})";
    s.sources[0].shape = "grain";
    return s;
  };
  BenchScene tile = scene(0);
  tile.step = kSettleStep;
  tile.sources[0].seeds = bench_lattice(count, lx, ly, 1.35 * kDiameter, 0.04 * kDiameter, 10);
  Random random(1, 11);
  for (Seed& seed : tile.sources[0].seeds) {
    // Uniform over rotations (Shoemake 1992).
    const double pi = 3.141592653589793, u = random.uniform(), a = 2 * pi * random.uniform(),
                 b = 2 * pi * random.uniform(), p = std::sqrt(1 - u), q = std::sqrt(u);
    seed.turn = {q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)};
  }
  settle_tile(tile, o);
  BenchScene s = scene(o.rolling);
  s.sources[0].seeds = tiled(tile.sources[0].seeds, wanted(o, 100000), lx, ly);
  put_in_box(s, lx, ly);
  return s;
}

}  // namespace calx
