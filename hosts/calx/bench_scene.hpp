// bench_scene.hpp: a timed scene: its case, the particles it starts with, and what it shows beside speed.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench_options.hpp"
#include "bench_row.hpp"
#include "sim/simulation.hpp"
#include "sim/source.hpp"

namespace calx {

/// Particles given outright: one source of the case, one CSV.
struct BenchSource {
  std::string name, shape, material;
  std::vector<Seed> seeds;
};

struct BenchScene {
  Vec3 gravity{0, 0, -9.81}, lo, hi;  // m, of the domain
  std::string periodic = "[false, false, false]";
  double step = 0;                                                 // s
  std::string materials, contacts, shapes, parts, motions = "{}";  // JSON
  std::vector<BenchSource> sources;
  /// Case-specific figures after the timed steps; may be empty.
  std::function<void(const Simulation&, BenchRow&)> physics;
};

/// A folder that goes with its owner, unless a name for it was given.
class BenchFolder {
 public:
  explicit BenchFolder(const std::string& path);
  ~BenchFolder();
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool keep_;
};

/// {"young": .., ...} of one material, and the law of a pair as LIGGGHTS sequences it: friction during a pulling
/// dashpot, tangential spring kept as a displacement. rolling: the friction of epsd2, 0 for none.
std::string bench_material(double density, double young, double poisson);
std::string bench_contact(const std::string& a, const std::string& b, double restitution, double friction,
                          double rolling);

/// case.json and a CSV per source in the folder; returns the path of the case.
std::string write_scene(const BenchScene& scene, const std::string& folder);
/// The case of a folder with the overrides of the command line.
CaseFile read_scene(const std::string& path, const BenchOptions& options);
void write_seeds(const std::string& path, const std::vector<Seed>& seeds);

/// Lets the scene run for that long, s, and puts the particles where they are then. Says so on stderr.
void settle(BenchScene& scene, double seconds, const BenchOptions& options);

/// A cubic lattice with jitter, from z = 0 up over a floor of lx by ly.
std::vector<Seed> bench_lattice(long long count, double lx, double ly, double pitch, double jitter,
                                std::uint64_t stream);
/// Spheres of the radii given (m, largest first) dropped at random into a region without overlaps. Throws Error where
/// they find no place.
std::vector<Vec3> scatter(const std::vector<double>& radii, const RegionSettings& region, std::uint64_t stream);
/// Copies of a tile of lx by ly side by side, 2.5 times as long as wide, until there are about that many; lx and ly
/// become the whole footprint.
std::vector<Seed> tiled(const std::vector<Seed>& tile, long long particles, double& lx, double& ly);

// The scenes by the name of the command line.
BenchScene settled_scene(const BenchOptions& options);
BenchScene pour_scene(const BenchOptions& options);
BenchScene sizes_scene(const BenchOptions& options);
BenchScene clumps_scene(const BenchOptions& options);
BenchScene penetration_scene(const BenchOptions& options);
// folder: for the meshes of the parts.
BenchScene drum_scene(const BenchOptions& options, const std::string& folder);
BenchScene chute_scene(const BenchOptions& options, const std::string& folder);
/// What a scene of that name shows beside speed; empty where it has nothing of its own.
std::function<void(const Simulation&, BenchRow&)> scene_physics(const std::string& name);

/// Runs a case file as it stands (fill) or a scene, times it and prints one row.
void time_case(CaseFile file, const std::function<void(const Simulation&, BenchRow&)>& physics,
               const BenchOptions& options);
/// Case law: two-body impacts to compare codes by, and the time of a law alone.
void bench_law(const BenchOptions& options);

}  // namespace calx
