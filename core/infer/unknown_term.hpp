// unknown_term.hpp: an effect outside the library as a sum of a few simple terms along one observable, named in words.
#pragma once
#include <string>
#include <vector>

#include "infer/diagnosis.hpp"

namespace calx::infer {

/// Log odds that a term outside the library needs beyond the log of the number of terms tried, nats.
constexpr double least_term_odds = 3;

struct UnknownTerm {
  std::size_t term = 0;  // in the bank
  double gain = 0;       // log odds it adds, less the log of the number of candidates
  double stability =
      0;                // share of knock-outs of a fifth of the numbers that choose the same family first; of the first
  Vector coefficients;  // of the term's columns, each of one declared sd
  double size = 0, size_sd = 0;  // of the first coefficient (norm of the two of a wave), unit of the observable; of a
                                 // displacement, unit of the index
  std::string words;
};

/// Forward selection by evidence in the block that the posterior of the unknown prefers, at most three terms, stopped
/// below 3 nats; smooth and rough terms only say that there is something, so they are no candidates. Stability
/// selection follows Meinshausen and Buehlmann (2010). Empty where no term earns its place.
std::vector<UnknownTerm> find_terms(const LinearModel& model, const Bank& bank, const Diagnosis& diagnosis,
                                    const Options& options);

}  // namespace calx::infer
