// cell_search.hpp: all pairs of spheres nearer than the sum of their reaches, by cells of several sizes.
//
// Spheres of like reach share a level, a grid whose cells are as wide as its largest pair distance. A sphere is
// compared with the half of the cells around its own that come later, and with the cells of finer levels in its reach,
// so that a few large or fast spheres do not force large cells on the others. A level whose box has many more cells
// than spheres is folded: cells far apart share an entry of the table, which costs comparisons but neither pairs nor
// memory.
#pragma once
#include <cstdint>
#include <vector>

#include "base/column.hpp"
#include "neighbour/wrap.hpp"
#include "store/particles.hpp"

namespace calx {

class CellSearch {
 public:
  /// What was found for a run of consecutive spheres.
  struct Run {
    std::vector<std::uint32_t> count;    // partners of each sphere of the run
    std::vector<std::uint32_t> partner;  // their ranks, all higher than the sphere's and rising, sphere by sphere
  };

  /// Finds every pair of spheres of different particles whose distance, over periodic images, is below the sum of radii
  /// and margins; each once. margin: m, one per particle. run_start: first sphere of each run, and the number of
  /// spheres at the end. gap: m, added to the distance. The result depends on neither the number of threads nor the
  /// instruction set. Threads: OpenMP.
  void find(const Particles& particles, const Wrap& wrap, const Column<double>& margin,
            const std::vector<std::uint32_t>& run_start, double gap = 0);
  const Run& run(std::size_t r) const { return runs_[r]; }
  std::size_t memory_bytes() const;

  struct View;
  /// A grid for spheres of like reach.
  struct Level {
    double reach = 0;              // m, the largest of its spheres
    double cell = 1;               // m
    double inverse = 1;            // 1/m
    std::uint32_t low[4] = {};     // cell coordinates of the lower corner of all spheres; three count
    std::uint32_t high[4] = {};    // and of the upper
    std::uint32_t stride[4] = {};  // of the number of a cell by coordinate
    std::uint32_t mask = 0;        // number of cells - 1; a power of two less one
    bool folded = false;
    std::uint32_t start = 0;            // its first cell in cell_start_
    std::uint32_t first = 0, last = 0;  // its places
  };

 private:
  /// Of one thread.
  struct Scratch {
    std::vector<std::uint64_t> pairs;  // lower rank << 32 | higher
    std::vector<std::uint32_t> next, rows;
    std::uint32_t first = 0;  // sphere of the run
  };
  void measure(const Particles& particles, const Wrap& wrap, const Column<double>& margin);
  void bin(const Particles& particles, const Wrap& wrap, const Column<double>& margin);
  void collect(std::size_t found, Scratch& scratch, Run& run) const;
  static void merge(const std::vector<std::uint64_t>& gained, std::uint32_t first, Run& run);
  static void drop_repeats(Run& run);

  std::vector<Level> levels_;  // rising reach
  Vec3 origin_;                // m, of cell coordinates
  double half_gap_ = 0;        // m, share of each sphere
  bool repeats_ = false;       // a pair may be met more than once
  std::vector<std::uint32_t> cell_start_;
  // Per sphere, by rank.
  std::vector<std::uint32_t> cell_of_, place_;
  // Per place: spheres in the order of cells, and copies of those of each level's first two cells after its last.
  Column<double> x_, y_, z_, reach_;  // m
  Column<std::uint32_t> rank_;
  std::vector<Run> runs_;
  std::vector<std::vector<std::uint64_t>> foreign_;  // per run: pairs found whose lower sphere is of an earlier run
  std::vector<Scratch> scratch_;
};

}  // namespace calx
