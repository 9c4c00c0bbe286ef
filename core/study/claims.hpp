// claims.hpp: causes that somebody claims, held against the sign of what they do. Private to study/.
#pragma once
#include <vector>

#include "study/diagnose.hpp"

namespace calx {

/// Throws Error(Fault::settings) with the pointer into the study.
std::vector<Claim> read_claims(const Study& study, const Library& library);

/// Fills in numbers, verdicts and sentences, once model, budget and recalibrated numbers are there.
void judge_claims(const Study& study, StudyDiagnosis& d);

}  // namespace calx
