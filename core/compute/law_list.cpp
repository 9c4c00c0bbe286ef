// law_list.cpp: runs a block of contacts through the laws of a list.
#include "compute/law_list.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

namespace calx {

BlockScratch::BlockScratch(std::uint32_t state_columns) {
  const std::size_t bytes = sizeof(double) * kBlockStride * (kFixedColumns + state_columns);
  const std::size_t rounded = (bytes + 63) / 64 * 64;
  void* p = std::aligned_alloc(64, rounded);
  if (!p) throw std::bad_alloc();
  // Rows beyond the count hold harmless numbers, so a law may round the count up.
  std::memset(p, 0, rounded);
  data_.reset(static_cast<double*>(p));
}

void BlockScratch::Free::operator()(double* p) const { std::free(p); }

void evaluate_block(const LawList& list, BlockScratch& scratch, double dt, double time, bool energy) {
  const std::uint32_t n = scratch.count;
  const int outputs = energy ? CALX_OUT_COUNT : 6;
  calx_block_f64 block{};
  block.struct_size = sizeof block;
  block.count = n;
  block.stride = kBlockStride;
  block.dt = dt;
  block.time = time;
  for (std::size_t t = 0; t < list.terms.size(); ++t) {
    const LawTerm& term = list.terms[t];
    for (int k = 0; k < CALX_IN_COUNT; ++k) block.in[k] = (term.table->needs >> k & 1u) != 0 ? scratch.in(k) : nullptr;
    for (int k = 0; k < outputs; ++k) block.out[k] = scratch.out(t == 0 ? k : CALX_OUT_COUNT + k);
    block.pair = term.pair_row.data();
    block.state = scratch.state(term.state_offset);
    if (term.table->needs >> CALX_IN_FN_BEFORE & 1u) {
      double* before = scratch.in(CALX_IN_FN_BEFORE);
      for (std::uint32_t i = 0; i < n; ++i)
        before[i] = t == 0 ? 0.0
                           : scratch.out(0)[i] * scratch.in(CALX_IN_NX)[i] +
                                 scratch.out(1)[i] * scratch.in(CALX_IN_NY)[i] +
                                 scratch.out(2)[i] * scratch.in(CALX_IN_NZ)[i];
    }
    term.table->eval_f64(&block);
    if (t == 0) continue;
    for (int k = 0; k < outputs; ++k) {
      double* sum = scratch.out(k);
      const double* add = scratch.out(CALX_OUT_COUNT + k);
      for (std::uint32_t i = 0; i < n; ++i) sum[i] += add[i];
    }
  }
}

}  // namespace calx
