// common_practice.hpp: what many do, for contrast: calibrate on bench tests, blame what lowers the error most.
#pragma once
#include "diagnosis/blind_study.hpp"

namespace calx::diagnosis {

/// Nuisances from bench tests alone, then the effect that cuts the squared error of everything most. Sets the two
/// members of the outcome that tell of it.
void common_practice(const Study& study, LineSimulator& simulator, Outcome& outcome);

}  // namespace calx::diagnosis
