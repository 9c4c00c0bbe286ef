// generic_fit.hpp: a generic term fitted and scored as an effect is, for a diagnosis that says "not in the library".
// Private to study/.
#pragma once
#include "study/diagnose.hpp"
#include "study/diagnosis_plan.hpp"

namespace calx {

/// Seeds behind the signature of each generic term.
constexpr std::size_t generic_seeds = 2;

/// Tries the generic terms of the study by runs at the place of the linear model, takes the one that the fitted
/// campaign makes likeliest, asks for its gain on the held-out campaign, and confirms it by runs of old and extended
/// case with new seeds. Adds the terms tried to the candidates of the library, and those that could not be to its
/// untested. Nothing is tried where the study asks for none.
GenericFit fit_generic_term(const Study& study, StudyDiagnosis& d, StudySimulator& simulator,
                            const DiagnosisPlan& plan);

}  // namespace calx
