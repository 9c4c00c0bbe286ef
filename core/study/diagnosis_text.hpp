// diagnosis_text.hpp: a diagnosis in words and as JSON. Private to study/.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "study/diagnose.hpp"

namespace calx {

/// The verdict in one or two sentences.
std::string diagnosis_sentence(const Study& study, const StudyDiagnosis& d);

/// diagnosis.json. extensions: case and path of each extended case.
std::string diagnosis_json(const Study& study, const StudyDiagnosis& d,
                           const std::vector<std::pair<std::string, std::string>>& extensions);

}  // namespace calx
