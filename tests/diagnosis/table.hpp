// table.hpp: figures of many blind studies beside their goals, with binomial intervals.
#pragma once
#include <string>
#include <vector>

#include "diagnosis/blind_study.hpp"

namespace calx::diagnosis {

/// k of n, with its 95 % interval (Clopper and Pearson 1934).
struct Rate {
  int k = 0, n = 0;
  void add(bool hit) { k += hit ? 1 : 0, n += 1; }
  double share() const { return n == 0 ? 0 : static_cast<double>(k) / n; }
  double low() const;
  double high() const;
};

/// Figures of the goals.
struct Table {
  Rate control_named, control_unknown, single_wrong, outside_named, single_right, clear_right, in_set, outside_flagged,
      pair_right, pair_wrong, sure_true, covered, family_right, next_right, next_wrong, random_right, practice_right,
      practice_named;
  double set_size = 0;
  int most_runs = 0;
};

Table tabulate(const std::vector<Outcome>& outcomes);
/// Goals table, confusion table, namings per cause, reliability and what refused the clear effects that were missed, as
/// plain text.
std::string describe(const std::vector<Outcome>& outcomes);

/// The rows that troubles are judged by, then one line per trouble.
std::string describe_troubles(const std::vector<Outcome>& outcomes);

/// What the next measurement settles.
std::string describe_next(const std::vector<Outcome>& outcomes);

/// One line per study: truth, verdict and what led to it.
std::string list_studies(const std::vector<Outcome>& outcomes);

}  // namespace calx::diagnosis
