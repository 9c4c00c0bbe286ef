// diagnosis_plan.hpp: how a diagnosis spends its budget of runs. Private to study/.
#pragma once
#include <vector>

#include "study/candidates.hpp"

namespace calx {

/// Runs of a plan: seeds of the base in each pass, effects run again at their fitted strength, rounds where base and
/// leading effects are run again where the leading one puts the parameters, seeds of base and effects in each, rounds
/// and seeds of the fit by runs of old and extended case, seeds of each side of the confirmation.
struct DiagnosisPlan {
  std::vector<int> base;
  int refined, rounds, rebased, leading, steps, step_seeds;
  std::size_t confirmed;
  int trials = 1, slopes = 1;  // seeds behind each signature, pairs behind each sensitivity: what the budget leaves
  std::size_t cases = 1, round_runs = 0, generic_runs = 0;  // cases of a run; runs of one round, of the generic terms

  /// Of both sides, with so many steps of the fit by runs.
  std::size_t confirmation_runs(int fit_steps) const {
    const int fitted = fit_steps > 0 ? (1 + fit_steps) * step_seeds : 0;
    return 2 * (static_cast<std::size_t>(fitted) + confirmed) * cases;
  }
};
/// Leading effects that are run again in each round, and where the first look leaves the verdict open.
constexpr int leaders = 2, rivals = 4;
/// Runs of each full case that carry what the reduced ones say.
constexpr std::size_t full_runs = 4;

/// The richest plan that the budget pays for. Where none does, candidates that the study did not name leave the
/// library, those that are declared to touch the least of what was measured first. planned: runs at most. Throws
/// Error(Fault::settings) where the budget pays for no plan.
DiagnosisPlan plan_of(const Study& study, Library& library, std::size_t* planned);

}  // namespace calx
