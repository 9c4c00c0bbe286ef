// terms.hpp: simple shapes along the index of an observable. They are the rival "not in the library" of every cause,
// and the words in which an unknown effect is described.
#pragma once
#include <string>
#include <vector>

#include "infer/observables.hpp"

namespace calx::infer {

/// One shape: columns of strength about one, in declared sd of its block.
struct Term {
  std::string family;  // constant, drift, decay, step, hinge, bump, periodic, sawtooth, smooth, rough
  double place = 0;  // of a step, hinge or bump, decay length, period or number of the harmonic; in units of the index
  std::size_t block = 0;
  Matrix columns;  // rows of the block
};

/// All terms of one block that its length can carry; members of a family stand together.
std::vector<Term> terms_of(const Observables& observables, std::size_t block);

}  // namespace calx::infer
