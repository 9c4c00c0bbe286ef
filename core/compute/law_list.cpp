// law_list.cpp: runs a block of contacts through the laws of a list.
#include "compute/law_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>

#include "base/error.hpp"

namespace calx {

namespace {

void evaluate(const LawTerm& term, calx_block_f64& block) {
  block.pair = term.pair_row.data();
  term.table->eval_f64(&block);
}
void evaluate(const LawTerm& term, calx_block_f32& block) {
  block.pair = term.pair_row_f32.data();
  term.table->eval_f32(&block);
}

/// Rows that do not touch: history of a term that does not survive separation is as new.
template <class Real>
void renew_apart(const LawList& list, const LawTerm& term, BlockScratchOf<Real>& scratch) {
  const Real* overlap = scratch.in(CALX_IN_OVERLAP);
  for (std::uint32_t h = term.state_offset; h < term.state_offset + term.table->state_count; ++h) {
    if (list.keep[h]) continue;
    Real* state = scratch.state(h);
    const Real preset = static_cast<Real>(list.preset[h]);
    for (std::uint32_t i = 0; i < scratch.count; ++i) state[i] = overlap[i] > 0 ? state[i] : preset;
  }
}

/// Rows that do not touch: a select, so that no NaN escapes from them.
template <class Real>
void drop_apart(BlockScratchOf<Real>& scratch, Real* const* out, int outputs) {
  const Real* overlap = scratch.in(CALX_IN_OVERLAP);
  for (int k = 0; k < outputs; ++k)
    for (std::uint32_t i = 0; i < scratch.count; ++i) out[k][i] = overlap[i] > 0 ? out[k][i] : Real(0);
}

}  // namespace

double reach_of(const LawList& list, double r_i, double r_j) {
  double largest = 0;
  for (const LawTerm& term : list.terms) {
    if (!term.table->reach) continue;
    const double gap = term.table->reach(term.pair_row.data(), r_i, r_j);
    if (!(gap >= 0 && std::isfinite(gap)))
      throw Error(Fault::plugin, list.label + ": the reach of law " + term.id + " is " + std::to_string(gap) +
                                     " m; 0 or more is needed");
    largest = std::max(largest, gap);
  }
  return largest;
}

template <class Real>
BlockScratchOf<Real>::BlockScratchOf(std::uint32_t state_columns) {
  const std::size_t bytes = sizeof(Real) * kColumnStride<Real> * (kFixedColumns + state_columns);
  const std::size_t rounded = (bytes + 63) / 64 * 64;
  void* p = std::aligned_alloc(64, rounded);
  if (!p) throw std::bad_alloc();
  // Rows beyond the count hold harmless numbers, so a law may round the count up.
  std::memset(p, 0, rounded);
  data_.reset(static_cast<Real*>(p));
}

template <class Real>
void BlockScratchOf<Real>::Free::operator()(Real* p) const {
  std::free(p);
}

template <class Real>
void evaluate_block(const LawList& list, BlockScratchOf<Real>& scratch, double dt, double time, bool energy) {
  const std::uint32_t n = scratch.count;
  const int outputs = energy ? CALX_OUT_COUNT : 6;
  std::conditional_t<std::is_same_v<Real, float>, calx_block_f32, calx_block_f64> block{};
  block.struct_size = sizeof block;
  block.count = n;
  block.stride = kColumnStride<Real>;
  block.dt = dt;
  block.time = time;
  for (std::size_t t = 0; t < list.terms.size(); ++t) {
    const LawTerm& term = list.terms[t];
    for (int k = 0; k < CALX_IN_COUNT; ++k) block.in[k] = (term.table->needs >> k & 1u) != 0 ? scratch.in(k) : nullptr;
    for (int k = 0; k < outputs; ++k) block.out[k] = scratch.out(t == 0 ? k : CALX_OUT_COUNT + k);
    block.state = scratch.state(term.state_offset);
    if (term.table->needs >> CALX_IN_FN_BEFORE & 1u) {
      Real* before = scratch.in(CALX_IN_FN_BEFORE);
      for (std::uint32_t i = 0; i < n; ++i)
        before[i] = t == 0 ? Real(0)
                           : scratch.out(0)[i] * scratch.in(CALX_IN_NX)[i] +
                                 scratch.out(1)[i] * scratch.in(CALX_IN_NY)[i] +
                                 scratch.out(2)[i] * scratch.in(CALX_IN_NZ)[i];
    }
    if (list.reaches) renew_apart(list, term, scratch);
    evaluate(term, block);
    if (list.reaches) {
      renew_apart(list, term, scratch);
      if (!term.table->reach) drop_apart(scratch, block.out, outputs);
    }
    if (t == 0) continue;
    for (int k = 0; k < outputs; ++k) {
      Real* sum = scratch.out(k);
      const Real* add = scratch.out(CALX_OUT_COUNT + k);
      for (std::uint32_t i = 0; i < n; ++i) sum[i] += add[i];
    }
  }
}

template struct BlockScratchOf<double>;
template struct BlockScratchOf<float>;
template void evaluate_block<double>(const LawList&, BlockScratchOf<double>&, double, double, bool);
template void evaluate_block<float>(const LawList&, BlockScratchOf<float>&, double, double, bool);

}  // namespace calx
