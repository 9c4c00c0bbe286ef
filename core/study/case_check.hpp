// case_check.hpp: the cases of a study are built, not run, before anything is spent. Private to study/.
#pragma once
#include "study/study.hpp"

namespace calx {

/// Builds the world of every case with all parameters at the middle, the lowest and the highest value, so that a value
/// that a plugin refuses is found here; checks that every sensor and column of the observables exists. Throws Error of
/// Fault::settings or of the kind the case gives, naming the place in the study.
void check_cases(const Study& study);

/// Checks that the case of a reading has its sensor and columns. pointer: where the reading stands in the study. Throws
/// as check_cases does.
void check_reading(const Study& study, const StudyObservable& reading, const std::string& pointer);

/// Builds the world of one run. Throws what reading the case and building it throw.
void try_run(const RunRequest& request, const std::vector<std::string>& plugin_path);

}  // namespace calx
