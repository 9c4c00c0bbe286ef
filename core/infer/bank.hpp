// bank.hpp: the rival "something is wrong that is not in the library": one or two structured discrepancies.
#pragma once
#include <vector>

#include "infer/metric.hpp"
#include "infer/terms.hpp"

namespace calx::infer {

/// All terms of all blocks; made once per set of observables.
struct Bank {
  std::vector<Term> terms;
  std::vector<double> log_share;  // of each term in the prior; sums to one over the bank
};

/// base: the observables as simulated (LinearModel::base), for curves displaced along their index; empty: none of them.
Bank make_bank(const Observables& observables, const Vector& base = {});

struct UnknownFit {
  double odds = 0;                  // log, against "no discrepancy"
  std::size_t term = 0;             // strongest
  double strength = 0;              // of it, prior sd in declared sd
  std::vector<double> block_share;  // posterior share of each block among single discrepancies
};

/// Columns of a term, all rows: in its own block and, where it adds up, in that of running sums.
Matrix columns_of(const Term& term, const Observables& observables);
Matrix whiten_term(const Term& term, const Observables& observables, const Metric& metric);
/// Whitened columns of the bank's terms.
std::vector<Matrix> whiten_bank(const Bank& bank, const Observables& observables, const Metric& metric);

/// log_distinct: log of the share of each term, where it acts alone, that no effect of a library has; empty: all of it.
UnknownFit fit_unknown(const Bank& bank, const std::vector<Matrix>& whitened, std::size_t blocks, const Metric& metric,
                       const std::vector<double>& log_distinct = {});

}  // namespace calx::infer
