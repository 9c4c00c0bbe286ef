// compare.hpp: two runs side by side: what they were given, what came out, and which difference may explain the other.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "report/run_folder.hpp"

namespace calx {

/// What was given, where the two differ. name: "seed", "plugin calx.epam", or a JSON pointer into the case.
struct GivenDifference {
  std::string name, a, b;  // as text; "-" where one has none
};

/// A number of both summaries. relative: (b - a) / |a|; not finite where a is 0 and b is not.
struct FigureDifference {
  std::string name;
  double a = 0, b = 0, difference = 0, relative = 0;
};

/// A column of a sensor that both have, b linear between its rows at the times of a.
struct SeriesDifference {
  std::string sensor, column;
  std::size_t rows = 0;  // compared, where both have a number
  double largest = 0;    // |b - a|, in the unit of the column
  double at = 0;         // s, where that is
  double range = 0;      // largest |a|
  bool same = true;      // every digit written, in the time that both cover
  bool in_step = true;   // rows at the same times
};

struct RunComparison {
  RunFolder a, b;
  std::vector<GivenDifference> provenance, given;  // of summary.json; of case.json
  std::vector<FigureDifference> figures;           // that both have, equal ones too
  std::vector<SeriesDifference> series;
  std::vector<std::string> only_a, only_b;  // figures and series that one of them lacks
  std::string verdict;                      // one or two sentences
};

/// Throws Error(Fault::files) for a folder that is none or holds no run.
RunComparison compare_runs(const std::string& a, const std::string& b);

/// For the terminal; for programs; a page of its own without outside references.
std::string comparison_text(const RunComparison& comparison);
std::string comparison_json(const RunComparison& comparison);
std::string comparison_page(const RunComparison& comparison);

}  // namespace calx
