// paper_figures.hpp: the figures of a publication's rows from finished runs, and where they lie against references.
#pragma once
#include <string>
#include <vector>

#include "report/paper_rows.hpp"
#include "report/run_folder.hpp"
#include "report/statistics.hpp"

namespace calx {

/// Whether a run's folder holds what the rows ask for.
enum class PaperRunState {
  missing,     // nothing there
  unfinished,  // running, interrupted or stopped
  outdated,    // of a case that has changed since in more than title, assumptions and output
  done
};
/// Throws Error(Fault::settings) for a case that cannot be read.
PaperRunState paper_run_state(const std::string& folder, const PaperForm& form, std::uint64_t seed);

/// The changes of a form, with the seed: what calx run gets as --set and --seed.
std::vector<std::pair<std::string, std::string>> paper_overrides(const PaperForm& form, std::uint64_t seed);

/// Where a number lies against a reference, from the numbers alone: +1 above, -1 below, 0 equal or inside the range.
/// amount: from the nearest end of the reference, same sign, in its unit.
struct PaperDifference {
  bool known = false;  // false: the reference holds no number
  int sign = 0;
  double amount = 0;
  double share = 0;  // amount over the magnitude of that end; NaN where that is 0
};
PaperDifference difference_to(double low, double high, const PaperReference& reference);

/// A row's figure over the seeds of one form.
struct PaperResult {
  bool begun = false;                // at least one of its runs has left something
  bool exists = false;               // the run has this form
  std::vector<RunFolder> runs;       // finished ones
  std::vector<double> values;        // in the row's unit, one a finished run that gives the figure
  Spread spread;                     // of values; of the difference when the row subtracts another run
  double pooled = 0;                 // sd of one run, pooled over both runs of a difference
  std::vector<std::string> missing;  // sentences: what is not there and why
};
/// seeds: how many of the run's seeds are asked for. out: the folder of the paper.
PaperResult paper_result(const PaperRows& rows, const PaperRow& row, int form, std::size_t seeds,
                         const std::string& out);

/// The row's figure from one run, in the row's unit. Throws Error(Fault::settings) that names row, sensor or column.
double paper_value(const PaperRows& rows, const PaperRow& row, int form, const RunFolder& run);

}  // namespace calx
