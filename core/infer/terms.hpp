// terms.hpp: simple shapes along the index of an observable. They are the rival "not in the library" of every cause,
// and the words in which an unknown effect is described.
#pragma once
#include <string>
#include <vector>

#include "infer/observables.hpp"

namespace calx::infer {

/// One shape: columns of strength about one, in declared sd of its block.
struct Term {
  std::string family;  // constant, drift, decay, step, hinge, bump, periodic, sawtooth, shift, smooth, rough
  double place = 0;    // of a step, hinge or bump, decay length, period, or displacement of a shift of strength one; in
                       // units of the index
  std::size_t block = 0;
  Matrix columns;  // rows of the block
  // What the shape adds up to in a block of running sums: a change of the powder is seen there, too, one of the
  // instrument is not. No rows: in its own block only.
  std::size_t sums_block = 0;
  Matrix sums;
};

/// All terms of one block that its length can carry; members of a family stand together, those that add up in a block
/// of running sums at the end. base: the block as simulated, for its displacement along the index; empty: left out.
std::vector<Term> terms_of(const Observables& observables, std::size_t block, const Vector& base = {});

}  // namespace calx::infer
