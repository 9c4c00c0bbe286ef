// bench_scene.cpp: cases from parts of text, starts from lattices, random places and settling.
#include "bench_scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/units.hpp"
#include "progress.hpp"

namespace calx {
namespace {

std::string vector_text(const Vec3& v) {
  return "[" + format_number(v.x) + ", " + format_number(v.y) + ", " + format_number(v.z) + "]";
}

}  // namespace

BenchFolder::BenchFolder(const std::string& path) : path_(path), keep_(!path.empty()) {
  namespace fs = std::filesystem;
  if (keep_) {
    fs::create_directories(path_);
    return;
  }
  std::string name = (fs::temp_directory_path() / "calx_bench_XXXXXX").string();
  if (!mkdtemp(name.data())) throw Error(Fault::files, name + ": cannot be made");
  path_ = name;
}

BenchFolder::~BenchFolder() {
  std::error_code ignored;
  if (!keep_) std::filesystem::remove_all(path_, ignored);
}

std::string bench_material(double density, double young, double poisson) {
  return R"({"density": )" + format_number(density) + R"(, "young": )" + format_number(young) + R"(, "poisson": )" +
         format_number(poisson) + "}";
}

std::string bench_contact(const std::string& a, const std::string& b, double restitution, double friction,
                          double rolling) {
  std::string text = R"({"between": [")" + a + R"(", ")" + b + R"("], "law": "calx.hertz-mindlin", "parameters": )" +
                     R"({"tension": "gripping", "tangential": "displacement", "restitution": )" +
                     format_number(restitution) + R"(, "friction": )" + format_number(friction);
  if (rolling > 0) text += R"(, "rolling": "epsd2", "rolling_friction": )" + format_number(rolling);
  return text + "}}";
}

void write_seeds(const std::string& path, const std::vector<Seed>& seeds) {
  std::ofstream out(path);
  out.precision(17);
  out << "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,qw_1,qx_1,qy_1,qz_1,scale\n";
  for (const Seed& s : seeds)
    out << s.x.x << ',' << s.x.y << ',' << s.x.z << ',' << s.v.x << ',' << s.v.y << ',' << s.v.z << ',' << s.w.x << ','
        << s.w.y << ',' << s.w.z << ',' << s.turn.w << ',' << s.turn.x << ',' << s.turn.y << ',' << s.turn.z << ','
        << s.scale << '\n';
  out.flush();
  if (!out) throw Error(Fault::files, path + ": cannot be written");
}

std::string write_scene(const BenchScene& s, const std::string& folder) {
  std::string sources;
  for (const BenchSource& source : s.sources) {
    write_seeds(folder + "/" + source.name + ".csv", source.seeds);
    sources += (sources.empty() ? "" : ",\n    ") + (R"({"name": ")" + source.name) + R"(", "shape": ")" +
               source.shape + R"(", "material": ")" + source.material + R"(", "file": ")" + source.name + R"(.csv"})";
  }
  std::ofstream out(folder + "/case.json");
  out << R"({"calx": 1, "title": "bench", "gravity": )" << vector_text(s.gravity) << ",\n"
      << R"(  "domain": {"min": )" << vector_text(s.lo) << R"(, "max": )" << vector_text(s.hi) << R"(, "periodic": )"
      << s.periodic << "},\n"
      << R"(  "time": {"step": )" << format_number(s.step) << R"(, "end": 1e6},)"
      << "\n"
      << R"(  "overlap_limit": 0.9,)"
      << "\n"
      << R"(  "materials": )" << s.materials << ",\n"
      << R"(  "contacts": [)" << s.contacts << "],\n"
      << R"(  "shapes": )" << s.shapes << ",\n"
      << R"(  "parts": [)" << s.parts << "],\n"
      << R"(  "motions": )" << s.motions << ",\n"
      << R"(  "sources": [)" << sources << "]\n}\n";
  out.close();
  if (!out) throw Error(Fault::files, folder + "/case.json: cannot be written");
  return folder + "/case.json";
}

CaseFile read_scene(const std::string& path, const BenchOptions& options) { return read_case(path, options.overrides); }

void settle(BenchScene& scene, double seconds, const BenchOptions& options) {
  const auto steps = static_cast<long long>(std::llround(seconds / scene.step));
  if (steps <= 0) return;
  std::size_t count = 0;
  for (const auto& source : scene.sources) count += source.seeds.size();
  std::fprintf(stderr, "settling %zu particles, %lld steps\n", count, steps);
  BenchFolder folder("");
  SimulationOptions simulation;
  simulation.threads = options.threads;
  simulation.plugin_path = options.plugin_path;
  // Settling is part of the scene's definition: it takes none of the overrides.
  Simulation sim(read_case(write_scene(scene, folder.path())), simulation);
  for (long long k = 0; k < steps; ++k) sim.step();
  // Ids are given in the order of the sources and their rows.
  const Particles& p = sim.world().particles();
  std::vector<std::size_t> rank(p.count());
  for (std::size_t k = 0; k < p.count(); ++k) rank[p.id[k]] = k;
  std::size_t id = 0;
  for (auto& source : scene.sources)
    for (Seed& seed : source.seeds) {
      const std::size_t k = rank[id++];
      seed.x = position(p.body[k]);
      seed.v = velocity(p.body[k]);
      seed.w = spin(p.body[k]);
      seed.turn = p.turn[k] * conjugate(p.shapes[p.shape[k]].frame);
    }
}

std::vector<Seed> bench_lattice(long long count, double lx, double ly, double pitch, double jitter,
                                std::uint64_t stream) {
  const long long nx = std::max<long long>(1, static_cast<long long>(lx / pitch)),
                  ny = std::max<long long>(1, static_cast<long long>(ly / pitch));
  Random random(1, stream);
  std::vector<Seed> out;
  for (long long k = 0; k < count; ++k) {
    const auto a = static_cast<double>(k % nx), b = static_cast<double>(k / nx % ny),
               c = static_cast<double>(k / (nx * ny));
    Seed s;
    s.x = {(a + 0.5) * lx / static_cast<double>(nx) + random.uniform(-jitter, jitter),
           (b + 0.5) * ly / static_cast<double>(ny) + random.uniform(-jitter, jitter),
           (c + 0.5) * pitch + random.uniform(-jitter, jitter)};
    out.push_back(s);
  }
  return out;
}

std::vector<Vec3> scatter(const std::vector<double>& radii, const RegionSettings& region, std::uint64_t stream) {
  constexpr int kTries = 20000;
  const Box box = region.bounds();
  const double cell = 2 * radii.front();
  std::map<std::array<long long, 3>, std::vector<std::size_t>> cells;
  std::vector<Vec3> out;
  Random random(1, stream);
  auto number = [&](double x) { return static_cast<long long>(std::floor(x / cell)); };
  auto free = [&](const Vec3& x, double r) {
    for (long long a = -1; a <= 1; ++a)
      for (long long b = -1; b <= 1; ++b)
        for (long long c = -1; c <= 1; ++c) {
          const auto found = cells.find({number(x.x) + a, number(x.y) + b, number(x.z) + c});
          if (found == cells.end()) continue;
          for (const std::size_t k : found->second)
            if (norm2(out[k] - x) < (radii[k] + r) * (radii[k] + r)) return false;
        }
    return true;
  };
  for (const double r : radii) {
    int tries = 0;
    Vec3 x;
    do {
      if (++tries > kTries)
        throw Error(Fault::usage, "bench: " + std::to_string(radii.size()) + " particles find no place, only " +
                                      std::to_string(out.size()) + " do; ask for another number");
      x = {random.uniform(box.lo.x, box.hi.x), random.uniform(box.lo.y, box.hi.y), random.uniform(box.lo.z, box.hi.z)};
    } while (!region.contains(x) || !free(x, r));
    cells[{number(x.x), number(x.y), number(x.z)}].push_back(out.size());
    out.push_back(x);
  }
  return out;
}

std::vector<Seed> tiled(const std::vector<Seed>& tile, long long particles, double& lx, double& ly) {
  const auto copies =
      std::max<long long>(1, std::llround(static_cast<double>(particles) / static_cast<double>(tile.size())));
  long long ny = std::max<long long>(1, static_cast<long long>(std::sqrt(static_cast<double>(copies) / 2.5 + 0.5)));
  while (copies % ny) --ny;
  const long long nx = copies / ny;
  std::vector<Seed> out;
  for (long long a = 0; a < nx; ++a)
    for (long long b = 0; b < ny; ++b)
      for (Seed s : tile) {
        s.x.x += static_cast<double>(a) * lx;
        s.x.y += static_cast<double>(b) * ly;
        out.push_back(s);
      }
  lx *= static_cast<double>(nx);
  ly *= static_cast<double>(ny);
  return out;
}

}  // namespace calx
