// law_list.hpp: the laws of one ordered material pair and how a block of contacts goes through them.
// Wrenches of a list add in its order; each law has its own pair row and its own history columns.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calx/contact_law.h"

namespace calx {

/// Rows of one block. Measured elsewhere and here: 64 to 512 are equally fast; all columns stay in the first-level
/// cache.
constexpr std::uint32_t kBlockRows = 256;
/// Rows between two columns: a cache line more than the block, because columns a power of two apart share cache sets.
template <class Real>
constexpr std::uint32_t kColumnStride = kBlockRows + 64 / sizeof(Real);
/// Of columns in double precision.
constexpr std::uint32_t kBlockStride = kColumnStride<double>;

struct LawTerm {
  const calx_contact_law* table = nullptr;
  std::string name, id;
  std::vector<double> pair_row;  // for (i, j) in this order
  std::vector<float> pair_row_f32;
  std::uint32_t state_offset = 0;  // first history column of this term
};

/// The laws between an ordered pair of materials.
struct LawList {
  std::vector<LawTerm> terms;
  std::uint32_t needs = 0;
  std::uint32_t state_count = 0;
  std::string label;               // "calcine-steel", for messages
  std::vector<double> preset;      // per history column
  std::vector<std::uint8_t> odd;   // per history column: changes sign when i and j trade places
  bool reaches = false;            // some term acts between surfaces that do not touch
  std::vector<std::uint8_t> keep;  // per history column of such a list: survives separation
};

/// Largest gap at which a term of the list acts, m; 0: only while touching. r_j = 0: a wall. Throws
/// Error(Fault::plugin) for a reach below 0 or not finite. [main]
double reach_of(const LawList& list, double r_i, double r_j);

/// Work space of one thread for one block; about 200 kB with 32 history columns of double. Real: double or float.
template <class Real>
struct BlockScratchOf {
  explicit BlockScratchOf(std::uint32_t state_columns);
  Real* in(int column) { return data_.get() + column * kColumnStride<Real>; }
  Real* out(int column) { return data_.get() + (CALX_IN_COUNT + column) * kColumnStride<Real>; }
  Real* state(std::uint32_t column) { return data_.get() + (kFixedColumns + column) * kColumnStride<Real>; }
  /// Rows in use, at most kBlockRows.
  std::uint32_t count = 0;

 private:
  static constexpr std::uint32_t kFixedColumns = CALX_IN_COUNT + 2 * CALX_OUT_COUNT;
  struct Free {
    void operator()(Real* p) const;
  };
  std::unique_ptr<Real, Free> data_;
};
using BlockScratch = BlockScratchOf<double>;

/// Evaluates scratch.count rows: reads in and state, writes out (0..5, and 6..9 when energy) and state. The law's text
/// in the precision of Real runs. In a row of a list that reaches whose overlap is not above 0, terms without reach do
/// nothing, and history that does not survive separation is as new before and after. [worker]
template <class Real>
void evaluate_block(const LawList& list, BlockScratchOf<Real>& scratch, double dt, double time, bool energy);

}  // namespace calx
