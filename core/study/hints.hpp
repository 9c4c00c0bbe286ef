// hints.hpp: what the reader of a diagnosis can do next, from the figures of this diagnosis. Private to study/.
#pragma once
#include <string>
#include <vector>

#include "study/diagnose.hpp"

namespace calx {

/// Whole sentences, the most useful first; none where there is nothing to say. Which effects of Calx the study left out
/// comes from the plugins found.
std::vector<std::string> hints_of(const Study& study, const StudyDiagnosis& d);

}  // namespace calx
