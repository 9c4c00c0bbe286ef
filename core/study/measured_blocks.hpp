// measured_blocks.hpp: the measured data of a study as blocks of the diagnosis: which numbers are fitted and which are
// held out. Private to study/.
#pragma once
#include "infer/observables.hpp"
#include "study/study.hpp"

namespace calx {

struct MeasuredBlocks {
  infer::Observables observables;
  std::vector<StudyObservable> readings;  // one per block: how a run gives its numbers
  std::vector<std::size_t> block_of;      // of each observable of the study
  bool split_repeats = false;             // the study holds nothing out: the later half of the repeats was taken for it
  bool has_hold_out = false;
};

/// One block per observable; two observables that read the same column at the same places, one fitted and one held out,
/// make one block. The sd of a block is that of the mean of its repeats, wider where it was estimated from a few of
/// them.
MeasuredBlocks measured_blocks(const Study& study);

/// Column vector of a list.
infer::Vector vector_of(const std::vector<double>& values);

}  // namespace calx
