// case_check.hpp: the cases of a study are built, not run, before anything is spent. Private to study/.
#pragma once
#include "study/study.hpp"

namespace calx {

/// Builds the world of every case with all parameters at the middle, the lowest and the highest value, so that a value
/// that a plugin refuses is found here; checks that every sensor and column of the observables exists. Throws Error of
/// Fault::settings or of the kind the case gives, naming the place in the study.
void check_cases(const Study& study);

}  // namespace calx
