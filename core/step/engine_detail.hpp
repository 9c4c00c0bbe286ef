// engine_detail.hpp: work spaces shared by the passes of a step. Private to step/.
#pragma once
#include <chrono>
#include <string>
#include <type_traits>
#include <vector>

#include "step/engine.hpp"
#include "step/kernels.hpp"

namespace calx {

/// Sums run over spans of so many spheres or particles of a chunk first, then over the spans of the chunk: an order
/// that a device of many small workers can follow; see kernels/fold.h.
constexpr std::uint32_t kSpan = 64;

/// Steps a list is meant to last for particles that keep their speed; see PairList about margins.
constexpr double kListSteps = 40;

/// What contacts store and lose, J.
struct EnergySums {
  double elastic = 0, friction = 0, damping = 0, plastic = 0;
  EnergySums& operator+=(const EnergySums& b) {
    elastic += b.elastic, friction += b.friction, damping += b.damping, plastic += b.plastic;
    return *this;
  }
};

/// A sum by spans; members come in the order of their spans.
template <class Sum>
struct SpanSum {
  Sum total{}, part{};
  std::size_t span = 0;
  void add(std::size_t its_span, const Sum& value) {
    if (its_span != span) close();
    span = its_span;
    part += value;
  }
  void close() {
    total += part;
    part = Sum{};
    span = 0;
  }
  /// The sum of all.
  const Sum& closed() {
    close();
    return total;
  }
};

/// Of the pair loop: a block and what it carries beside what a law sees.
template <class Precision>
struct Engine::PairWork {
  using Real = typename Precision::Real;
  explicit PairWork(std::uint32_t state_columns) : scratch(state_columns) {}
  BlockScratchOf<Real> scratch;
  alignas(64) Real arm_i[kColumnStride<Real>], arm_j[kColumnStride<Real>];
  /// Visits the columns that sums are made of, with their namesakes of another work space.
  template <class Visit>
  void each_column(PairWork& other, bool energy, const Visit& visit) {
    for (const int k : {CALX_IN_OVERLAP, CALX_IN_R_EFF, CALX_IN_NX, CALX_IN_NY, CALX_IN_NZ})
      visit(scratch.in(k), other.scratch.in(k));
    for (int k = 0; k < (energy ? CALX_OUT_COUNT : 6); ++k) visit(scratch.out(k), other.scratch.out(k));
    visit(arm_i, other.arm_i);
    visit(arm_j, other.arm_j);
  }
};

/// Work space of a thread.
struct Engine::Worker {
  explicit Worker(std::uint32_t state_columns)
      : in_double(state_columns), in_mixed(state_columns), assembled_double(0), assembled_mixed(0) {}
  PairWork<InDouble> in_double;
  PairWork<InMixed> in_mixed;
  PairWork<InDouble> assembled_double;  // of several law lists
  PairWork<InMixed> assembled_mixed;
  template <class Precision>
  PairWork<Precision>& pair_work() {
    if constexpr (std::is_same_v<Precision, InMixed>)
      return in_mixed;
    else
      return in_double;
  }
  template <class Precision>
  PairWork<Precision>& assembled() {
    if constexpr (std::is_same_v<Precision, InMixed>)
      return assembled_mixed;
    else
      return assembled_double;
  }
  PairScan scan;
  PairBlock found, picked;  // touching pairs, and those of them that one law list takes
  const LawList* list_of_row[kBlockRows];
  std::uint32_t row_of[kBlockRows];  // of found, for each row of picked
  // Wall block.
  std::uint32_t wall_count = 0;
  const LawList* wall_law = nullptr;
  SurfacePoint found_points[kWallContacts];
  std::uint32_t wall_sphere[kBlockRows], wall_part[kBlockRows];
  std::size_t wall_slot[kBlockRows];
  Vec3 wall_arm[kBlockRows], wall_lever[kBlockRows], wall_velocity[kBlockRows], wall_spin[kBlockRows];
  // Columns for particle forces.
  std::vector<double> columns;
};

struct alignas(64) Engine::ChunkResult {
  SpanSum<EnergySums> energy;                                                    // of contacts
  SpanSum<double> wall_work;                                                     // J
  SpanSum<double> force_work;                                                    // J
  SpanSum<double> kinetic_translation, kinetic_rotation, gravity, gravity_work;  // J
  double largest_overlap = 0;
  std::uint32_t overlap_i = 0, overlap_j = 0;  // spheres; j = ~part for a wall
  std::uint64_t touching = 0;
  bool stale = false, bad = false;
  std::uint32_t bad_particle = 0;
  std::vector<std::uint32_t> outside;
  std::vector<Wrench> load, span_load;  // on each part; of the present span of wall rows
  std::size_t load_span = 0;
};

/// Which numbers of a particle are not finite or beyond 1e30, and where it is, or where its first sphere was when the
/// lists were built if that is no place: "velocity y, spin x, at (0, 0, 0.1) m".
std::string bad_motion(const Record& particle, const Vec3& listed);

/// Rows of a block that touch; others are within reach of a law.
template <class Real>
std::uint32_t touching_rows(BlockScratchOf<Real>& block, std::uint32_t rows) {
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < rows; ++k) count += block.in(CALX_IN_OVERLAP)[k] > 0;
  return count;
}

inline double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace calx
