// bench.cpp: particle-steps per second of a settled bed and of a stream falling on one.
//
// The bed: 10 000 spheres of 2.5 mm poured into a 50 x 50 mm box and settled once (or read from a file), repeated side
// by side up to the number asked for, walls of the same material at the edges. Same law and step as the peers' decks.
#include "bench.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/version.hpp"
#include "options.hpp"
#include "sim/simulation.hpp"
#include "sim/source.hpp"

namespace calx {
namespace {

constexpr double kDiameter = 2.5e-3, kTile = 0.05;
constexpr int kTileCount = 10000;

struct Bench {
  std::string name, start, save;
  long long particles = 100000;
  int threads = 1, steps = 400, warm_up = 100;
  double rolling = 0;
  bool json = false, mixed = false;
};

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// A case with the spheres given in a box of the footprint given; step in s.
CaseFile box_case(const std::vector<Seed>& seeds, double lx, double ly, double step, double rolling) {
  std::ostringstream j;
  j.precision(17);
  j << R"({"calx": 1, "title": "bench", "domain": {"min": [-0.01, -0.01, -0.01], "max": [)" << lx + 0.01 << ","
    << ly + 0.01 << R"(, 2.0]}, "time": {"step": )" << step << R"(, "end": 1000},
    "materials": {"sand": {"density": 2100, "young": 1e7, "poisson": 0.25}},
    "contacts": [{"between": ["sand", "sand"], "law": "calx.hertz-mindlin",
                  "parameters": {"restitution": 0.3, "friction": 0.5)";
  if (rolling > 0) j << R"(, "rolling": "epsd2", "rolling_friction": )" << rolling;
  j << R"(}}], "shapes": {"ball": {"sphere": {"radius": 0.00125}}},
    "parts": [{"name": "box", "geometry": "calx.box", "material": "sand",
               "parameters": {"min": [0, 0, 0], "max": [)"
    << lx << "," << ly << R"(, 1.9]}}],
    "sources": [{"name": "bed", "shape": "ball", "material": "sand", "positions": [[0, 0, 0]]}], "overlap_limit": 0.9})";
  CaseFile file = parse_case(j.str(), "bench");
  auto& source = file.settings.sources[0];
  source.positions.clear();
  for (const auto& s : seeds) {
    source.positions.push_back(s.x);
    source.velocities.push_back(s.v);
  }
  return file;
}

std::vector<Seed> state_of(const Simulation& sim) {
  std::vector<Seed> out;
  for (const auto& b : sim.world().particles().body) {
    Seed s;
    s.x = position(b);
    s.v = velocity(b);
    out.push_back(s);
  }
  return out;
}

/// One tile, settled: a jittered lattice falls for 0.25 s with 20 % of the Rayleigh step.
std::vector<Seed> settled_tile(int threads) {
  std::vector<Seed> seeds;
  Random random(1, 7);
  const double pitch = 1.15 * kDiameter;
  const int side = static_cast<int>(kTile / pitch);
  for (int k = 0; k < kTileCount; ++k) {
    Seed s;
    const double jitter = 0.06 * kDiameter;
    s.x = {(k % side + 0.5) * kTile / side + random.uniform(-jitter, jitter),
           (k / side % side + 0.5) * kTile / side + random.uniform(-jitter, jitter),
           (k / (side * side) + 0.5) * pitch + random.uniform(-jitter, jitter) + 1e-4};
    seeds.push_back(s);
  }
  SimulationOptions options;
  options.threads = threads;
  Simulation sim(box_case(seeds, kTile, kTile, 1.96e-5, 0), options);
  for (int k = 0; k < 12700; ++k) sim.step();
  return state_of(sim);
}

std::vector<Seed> tiled(const std::vector<Seed>& tile, long long particles, double& lx, double& ly) {
  const auto copies =
      std::max<long long>(1, std::llround(static_cast<double>(particles) / static_cast<double>(tile.size())));
  long long ny = static_cast<long long>(std::sqrt(static_cast<double>(copies) / 2.5 + 0.5));
  ny = std::max<long long>(1, ny);
  while (copies % ny) --ny;
  const long long nx = copies / ny;
  lx = static_cast<double>(nx) * kTile;
  ly = static_cast<double>(ny) * kTile;
  std::vector<Seed> out;
  for (long long a = 0; a < nx; ++a)
    for (long long b = 0; b < ny; ++b)
      for (Seed s : tile) {
        s.x.x += static_cast<double>(a) * kTile;
        s.x.y += static_cast<double>(b) * kTile;
        out.push_back(s);
      }
  return out;
}

/// B2: the upper half of the bed is taken off and falls back as a jittered lattice at 1.5 m/s.
std::vector<Seed> pour_start(std::vector<Seed> bed, double lx, double ly) {
  double top = 0;
  for (const auto& s : bed) top = std::max(top, s.x.z);
  std::vector<Seed> out;
  for (const auto& s : bed)
    if (s.x.z < 0.5 * top) out.push_back(s);
  const std::size_t falling = bed.size() - out.size();
  const double pitch = 1.15 * kDiameter;
  const auto nx = static_cast<std::size_t>(lx / pitch), ny = static_cast<std::size_t>(ly / pitch);
  Random random(1, 8);
  for (std::size_t k = 0; k < falling; ++k) {
    Seed s;
    const double jitter = 0.06 * kDiameter;
    s.x = {(static_cast<double>(k % nx) + 0.5) * lx / static_cast<double>(nx) + random.uniform(-jitter, jitter),
           (static_cast<double>(k / nx % ny) + 0.5) * ly / static_cast<double>(ny) + random.uniform(-jitter, jitter),
           0.5 * top + 2 * kDiameter + static_cast<double>(k / (nx * ny)) * pitch + random.uniform(-jitter, jitter)};
    s.v = {0, 0, -1.5};
    out.push_back(s);
  }
  return out;
}

void write_seeds(const std::string& path, const std::vector<Seed>& seeds) {
  std::ofstream out(path);
  out.precision(17);
  out << "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n";
  for (const auto& s : seeds)
    out << s.x.x << ',' << s.x.y << ',' << s.x.z << ',' << s.v.x << ',' << s.v.y << ',' << s.v.z << '\n';
  if (!out) throw Error(Fault::files, path + ": cannot be written");
}

void run_bench(const Bench& b) {
  double lx = 0, ly = 0;
  std::vector<Seed> tile;
  if (!b.start.empty()) {
    tile = read_seeds(b.start);
  } else {
    std::fprintf(stderr, "settling %d spheres once\n", kTileCount);
    tile = settled_tile(b.threads);
  }
  if (!b.save.empty()) write_seeds(b.save, tile);
  std::vector<Seed> seeds = tiled(tile, b.particles, lx, ly);
  if (b.name == "pour") seeds = pour_start(seeds, lx, ly);
  SimulationOptions options;
  options.threads = b.threads;
  options.mixed = b.mixed;
  Simulation sim(box_case(seeds, lx, ly, 9.8e-6, b.rolling), options);
  seeds = {};
  for (int k = 0; k < b.warm_up; ++k) sim.step();
  const auto before = sim.counters();
  const double start = seconds();
  for (int k = 0; k < b.steps; ++k) sim.step();
  const double wall = seconds() - start;
  const auto after = sim.counters();
  const auto n = static_cast<double>(sim.world().particles().count());
  const double rate = n * b.steps / wall;
  double kinetic = 0, floor = 0, weight = 0;
  const Particles& p = sim.world().particles();
  for (std::size_t k = 0; k < p.count(); ++k) {
    kinetic += p.kinetic_energy(k);
    weight += p.mass(k) * 9.81;
  }
  floor = -sim.world().part_load(0).force.z;
  std::size_t pairs = 0, walls = 0;
  for (const auto& c : sim.world().contacts()) (c.part < 0 ? pairs : walls) += 1;
  const double neighbour = after.seconds_neighbour - before.seconds_neighbour,
               contacts = after.seconds_contacts - before.seconds_contacts,
               integrate = after.seconds_integrate - before.seconds_integrate;
  if (b.json) {
    std::printf(
        "{\"bench\": \"%s\", \"calx\": \"%s\", \"git\": \"%s\", \"particles\": %.0f, \"threads\": %d, \"steps\": %d, "
        "\"wall_s\": %.6g, \"particle_steps_per_second\": %.6g, \"ns_per_contact\": %.6g, \"bytes_per_sphere\": %.6g, "
        "\"entries_per_particle\": %.4g, \"pairs_per_particle\": %.4g, \"walls_per_particle\": %.4g, "
        "\"rebuilds\": %llu, \"share_neighbour\": %.4g, \"share_contacts\": %.4g, \"share_integrate\": %.4g, "
        "\"kinetic_J\": %.6g, \"floor_over_weight\": %.6g}\n",
        b.name.c_str(), version(), git_revision(), n, b.threads, b.steps, wall, rate,
        1e9 * wall / b.steps / static_cast<double>(std::max<std::size_t>(1, pairs + walls)),
        static_cast<double>(sim.memory_bytes()) / n, static_cast<double>(after.pair_entries) / n,
        static_cast<double>(pairs) / n, static_cast<double>(walls) / n,
        static_cast<unsigned long long>(after.rebuilds - before.rebuilds), neighbour / wall, contacts / wall,
        integrate / wall, kinetic, floor / weight);
    return;
  }
  std::printf("%s, %.0f particles, %d threads: %.2f M particle-steps/s\n", b.name.c_str(), n, b.threads, rate * 1e-6);
  std::printf(
      "  %.1f ns per contact, %.2f pair contacts and %.2f list entries per particle, %llu list rebuilds in %d steps\n",
      1e9 * wall / b.steps / static_cast<double>(std::max<std::size_t>(1, pairs + walls)),
      static_cast<double>(pairs) / n, static_cast<double>(after.pair_entries) / n,
      static_cast<unsigned long long>(after.rebuilds - before.rebuilds), b.steps);
  std::printf("  %.0f bytes per sphere; time: lists %.1f %%, contacts %.1f %%, sums and integration %.1f %%\n",
              static_cast<double>(sim.memory_bytes()) / n, 100 * neighbour / wall, 100 * contacts / wall,
              100 * integrate / wall);
  std::printf("  force on the box / weight %.4f, kinetic energy %.3g J\n", floor / weight, kinetic);
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "timed scenes: settled (B1), pour (B2)");
  auto b = std::make_shared<Bench>();
  b->name = "settled";
  command->add_option("name", b->name, "settled or pour")->check(CLI::IsMember({"settled", "pour"}));
  command->add_option("--particles", b->particles, "number of spheres, in tiles of the start state")
      ->check(whole_above_zero());
  command->add_option("--threads", b->threads, "threads")->check(whole_above_zero());
  command->add_option("--steps", b->steps, "timed steps")->check(whole_above_zero());
  command->add_option("--warm-up", b->warm_up, "steps before timing")->check(whole_number());
  command->add_option("--rolling", b->rolling, "rolling friction, 0 for none")->check(zero_or_more());
  command->add_option("--start", b->start, "CSV with the settled tile of 50 x 50 mm (default: settle one)");
  command->add_option("--save", b->save, "write the settled tile to this CSV");
  command->add_flag("--mixed", b->mixed, "pair contacts in single precision");
  command->add_flag("--json", b->json, "one JSON line");
  command->callback([b] { run_bench(*b); });
}

}  // namespace calx
