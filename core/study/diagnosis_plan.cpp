#include "study/diagnosis_plan.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "study/generic_fit.hpp"
#include "study/generic_terms.hpp"

namespace calx {
namespace {

/// What is bought with runs that a plan leaves, one after the other.
constexpr std::array<int DiagnosisPlan::*, 9> extras = {
    &DiagnosisPlan::trials,     &DiagnosisPlan::slopes,     &DiagnosisPlan::slopes,
    &DiagnosisPlan::leading,    &DiagnosisPlan::step_seeds, &DiagnosisPlan::leading,
    &DiagnosisPlan::step_seeds, &DiagnosisPlan::trials,     &DiagnosisPlan::slopes};
const std::array<DiagnosisPlan, 6> plans = {{{{6, 6, 10}, 6, 3, 8, 6, 5, 5, 8},
                                             {{4, 4, 6}, 4, 3, 6, 4, 4, 4, 6},
                                             {{3, 3, 4}, 3, 2, 4, 3, 3, 3, 4},
                                             {{3, 2, 3}, 2, 2, 3, 2, 2, 2, 3},
                                             {{2, 2, 2}, 1, 1, 3, 1, 1, 2, 2},
                                             {{2, 2}, 0, 0, 0, 0, 0, 2, 2}}};

std::size_t used_cases(const Study& study, const std::vector<StudyObservable>& readings, bool reduced_only) {
  return static_cast<std::size_t>(std::count_if(study.cases.begin(), study.cases.end(), [&](const StudyCase& c) {
    return (!reduced_only || !c.reduced.empty()) &&
           std::any_of(readings.begin(), readings.end(),
                       [&](const StudyObservable& o) { return o.case_name == c.name; });
  }));
}

/// Fills in what a round costs.
std::size_t runs_of(const Study& study, const Library& library, DiagnosisPlan& plan) {
  const std::size_t cases = used_cases(study, study.observables, false);
  std::size_t runs = cases;  // the partner of the runs with effects
  for (const int n : plan.base) runs += static_cast<std::size_t>(n) * cases;
  bool some_leave_a_case = false;
  for (const StudyParameter& p : study.parameters) {
    const std::size_t reached = std::min(p.cases.size(), cases);
    runs += static_cast<std::size_t>(2 * plan.slopes) * reached;
    some_leave_a_case = some_leave_a_case || reached < cases;
  }
  if (some_leave_a_case) runs += cases;
  std::size_t most = 0;
  for (const Candidate& c : library.candidates) {
    if (c.info.is_instrument) continue;
    const auto reached = static_cast<std::size_t>(std::count(c.cases.begin(), c.cases.end(), true));
    runs += static_cast<std::size_t>(c.effect.components * plan.trials) * reached;
    most = std::max(most, reached);
  }
  plan.cases = cases;
  plan.round_runs =
      static_cast<std::size_t>(leaders * plan.leading) * most + static_cast<std::size_t>(1 + plan.rebased) * cases;
  runs += static_cast<std::size_t>(plan.refined) * most + static_cast<std::size_t>(plan.rounds) * plan.round_runs;
  plan.generic_runs = read_generic_terms(study).size() * generic_seeds * cases;
  runs += plan.generic_runs + plan.confirmation_runs(plan.steps);
  return runs + full_runs * used_cases(study, study.observables, true);
}

}  // namespace

DiagnosisPlan plan_of(const Study& study, Library& library, std::size_t* planned) {
  for (DiagnosisPlan plan : plans) {
    *planned = runs_of(study, library, plan);
    if (*planned > study.budget) continue;
    for (int DiagnosisPlan::*extra : extras) {
      DiagnosisPlan more = plan;
      more.*extra += 1;
      if (runs_of(study, library, more) <= study.budget) plan = more;
    }
    *planned = runs_of(study, library, plan);
    return plan;
  }
  DiagnosisPlan poorest = plans.back();
  library.runs_for_all = *planned;
  while (*planned > study.budget) {
    std::size_t least = library.candidates.size();
    for (std::size_t c = 0; c < library.candidates.size(); ++c) {
      const Candidate& one = library.candidates[c];
      if (one.named || one.info.is_instrument) continue;
      if (least == library.candidates.size() || one.touched < library.candidates[least].touched) least = c;
    }
    if (least == library.candidates.size()) break;
    library.untested.push_back({library.candidates[least].effect.id, "the budget of runs does not pay for it"});
    library.candidates.erase(library.candidates.begin() + static_cast<std::ptrdiff_t>(least));
    *planned = runs_of(study, library, poorest);
  }
  if (*planned <= study.budget) return poorest;
  throw Error(Fault::settings, study.file + " /budget/runs: " + std::to_string(study.budget) +
                                   " runs are too few; the cases with " + std::to_string(study.parameters.size()) +
                                   " parameters need " + std::to_string(*planned) + " at least. Give --budget " +
                                   std::to_string(*planned) + " or more");
}

}  // namespace calx
