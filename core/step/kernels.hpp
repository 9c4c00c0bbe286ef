// kernels.hpp: the hot loops of a step, compiled once per instruction set. Plain structures and pointers only; every
// set gives the same bits, because nothing is contracted or reassociated. Private to step/.
#pragma once
#include <cstddef>
#include <cstdint>

#include "compute/law_list.hpp"
#include "neighbour/pair_list.hpp"
#include "store/particles.hpp"

namespace calx {

/// A sphere as the pair loop in mixed precision sees it: one cache line. The position is exact, so that overlaps are
/// differences of doubles; all else has single precision.
struct alignas(64) LeanRecord {
  double x, y, z, r;       // m
  float vx, vy, vz, m;     // m/s, kg
  float wx, wy, wz, none;  // rad/s
};
/// Sums of a sphere's pair contacts in mixed precision.
struct alignas(32) LeanWrench {
  float fx = 0, fy = 0, fz = 0, none = 0, tx = 0, ty = 0, tz = 0, none_too = 0;  // N, N m
};

/// Types of the pair loop in a precision.
struct InDouble {
  using Real = double;
  using Sphere = Record;
  using Sum = Wrench;
};
struct InMixed {
  using Real = float;
  using Sphere = LeanRecord;
  using Sum = LeanWrench;
};

/// Touching pairs found in a run of list entries. Rows beyond the count hold copies of a valid row.
struct PairBlock {
  std::uint32_t count = 0;
  alignas(64) std::uint32_t i[kBlockStride], j[kBlockStride];  // sphere ranks
  alignas(64) std::uint32_t entry[kBlockStride];               // relative to the chunk's first entry
  alignas(64) std::uint32_t ordinal[kBlockStride];             // entries of the chunk before this one that leave it
  /// Loops over rows go four at a time.
  void repeat_last_row() {
    for (std::uint32_t k = count; count > 0 && k < count + 3; ++k) {
      entry[k] = entry[count - 1];
      i[k] = i[count - 1];
      j[k] = j[count - 1];
    }
  }
};

/// A chunk's entries as the search for touching pairs walks over them.
struct PairScan {
  const void* spheres;  // Sphere of the precision
  const std::uint32_t *i, *j;
  std::uint8_t* touching;
  const double* history;  // of entry 0
  std::size_t width;      // values of an entry
  const void* sums;       // Sum of the precision
  const Wrap* wrap;       // null where nothing is periodic
  /// Null: pairs are found that touch. Else also those with a gap below gaps[material_i * materials + material_j], m.
  const double* gaps;
  std::uint32_t materials;
  const std::uint32_t* material;  // per particle
  const std::uint32_t* owner;     // per sphere, its particle; null: each its own
  /// Null: every entry from next_entry to last_entry is looked at. Else i, j, chosen (entries relative to first_entry)
  /// and chosen_ordinal are lists of the entries to look at, next_entry and last_entry count in these lists, and three
  /// spare numbers follow each of them.
  const std::uint32_t *chosen, *chosen_ordinal;
  std::size_t first_entry, next_entry, last_entry;
  std::uint32_t last_sphere;  // of the chunk
  std::uint32_t crossed;      // entries before next_entry that leave the chunk
  std::uint32_t started;      // rows of the block, listed in fresh, that did not touch at the last step
  std::uint32_t fresh[kBlockRows];
};

/// What the law sees of a block; wx, wy, wz and r_i, r_j are not written where they are null. arm_i, arm_j: m, from
/// each centre to the contact point.
template <class Real>
struct PairColumns {
  Real *overlap, *nx, *ny, *nz, *vx, *vy, *vz, *wx, *wy, *wz, *r_eff, *m_eff, *r_i, *r_j, *arm_i, *arm_j;
};

/// Where the wrenches of a block go: own spheres of the chunk directly, others into slots.
template <class Precision>
struct PairSums {
  const typename Precision::Real *nx, *ny, *nz, *fx, *fy, *fz, *mx, *my, *mz, *arm_i, *arm_j;
  typename Precision::Sum* sums;
  std::uint32_t last_sphere;
  const std::uint32_t* cross;  // slot of the n-th entry of the chunk that leaves it
  typename Precision::Sum* slot_wrench;
  std::uint8_t* slot_used;
};

/// Bounds on where particles of a run are and how fast they use up their margins.
struct Survey {
  double lo[4], hi[4];  // m, of centres
  double pace2;         // 1/s^2, at least (speed of any point of a particle / its margin)^2
  double squares;       // not finite, or huge, where some velocity or spin is
};

/// Columns of a tile of the rotation loop.
constexpr std::uint32_t kTurnRows = 128;
struct TurnTile {
  alignas(64) double qw[kTurnRows], qx[kTurnRows], qy[kTurnRows], qz[kTurnRows];
  alignas(64) double wx[kTurnRows], wy[kTurnRows], wz[kTurnRows];  // spin, world frame
  alignas(64) double tx[kTurnRows], ty[kTurnRows], tz[kTurnRows];  // torque
  alignas(64) double ix[kTurnRows], iy[kTurnRows], iz[kTurnRows];  // principal moments
  alignas(64) double before[kTurnRows], after[kTurnRows];          // energy of rotation, J
};

/// Pair loop of one precision.
template <class Precision>
struct PairKernels {
  using Real = typename Precision::Real;
  /// Fills the block with the next touching pairs; marks entries that touch and that do not. True while entries remain.
  bool (*find)(PairScan& scan, PairBlock& block);
  /// Kinematics of block.count rows. The contact point lies in the middle of the overlap; velocity: that of i relative
  /// to j at the contact point. True if some row may have overlap / (2 r_eff) above largest.
  bool (*kinematics)(const typename Precision::Sphere* spheres, const Wrap* wrap, const PairBlock& block,
                     double largest, const PairColumns<Real>& out);
  /// Rows of history into columns of the law, and back. history: of the chunk's first entry; width: values of an entry;
  /// count: columns, kColumnStride<Real> apart.
  void (*read_history)(const double* history, std::uint32_t width, const PairBlock& block, std::uint32_t count,
                       Real* columns);
  void (*write_history)(double* history, std::uint32_t width, const PairBlock& block, std::uint32_t count,
                        const Real* columns);
  /// Adds forces and torques of a block to its spheres.
  void (*scatter)(const PairBlock& block, const PairSums<Precision>& out);
};

struct StepKernels {
  PairKernels<InDouble> in_double;
  PairKernels<InMixed> in_mixed;
  /// Lean records of spheres.
  void (*thin)(const Record* spheres, std::size_t count, LeanRecord* out);
  /// Adds sums in mixed precision to sums in double.
  void (*widen)(const LeanWrench* from, std::size_t count, Wrench* to);
  /// Semi-implicit Euler for particles of one sphere, or the translation of clumps; wrench: sums of each particle.
  void (*move_spheres)(Record* body, const Wrench* wrench, std::size_t count, const double gravity[3], double dt);
  void (*move_clumps)(Record* body, const Wrench* wrench, std::size_t count, const double gravity[3], double dt);
  /// haste: 1 / margin^2 of each particle, 1/m^2, rounded up.
  void (*survey)(const Record* body, const float* haste, std::size_t count, bool clumps, Survey& out);
  /// Turns bodies over dt by the midpoint rule: angular momentum gets torque * kick, the body turns freely (momentum
  /// kept exactly), then momentum gets torque * late_kick.
  void (*turn_bodies)(std::uint32_t n, TurnTile& tile, double dt, double kick, double late_kick);
};

/// The best set this processor has; the variable CALX_INSTRUCTION_SET (plain, x86-64-v3, x86-64-v4) asks for a lesser
/// one. Throws Error(Fault::usage) for a set that is unknown or not there.
const StepKernels& step_kernels();

}  // namespace calx
