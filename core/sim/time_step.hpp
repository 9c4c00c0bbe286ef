// time_step.hpp: every limit of the time step side by side, and the one that binds.
#pragma once
#include <vector>

#include "sim/laws.hpp"
#include "sim/simulation.hpp"
#include "sim/source.hpp"
#include "store/particles.hpp"

namespace calx {

struct StepInputs {
  const CaseSettings* settings = nullptr;
  const CaseLaws* laws = nullptr;
  const std::vector<Shape>* shapes = nullptr;
  const std::vector<Source>* sources = nullptr;
  double particle_speed = 0;  // m/s, the largest expected
  double wall_speed = 0;      // m/s, the largest of any part
  std::string fastest_part;
};

/// Limits of one step, s (EPAM.md section 3). Rayleigh: fraction times pi R sqrt(rho/G) / (0.1631 nu + 0.8766) of the
/// smallest sphere. Law: what the law itself states for the lightest pair at the overlap of the fastest impact. Hertz:
/// a twentieth of the collision time 2.87 (m*^2 / (R* E*^2 v))^0.2. Wall: a part may move 2 % of the smallest radius.
/// The smallest is marked. All are advice; each also says above what a step is refused: half the Rayleigh time, three
/// times a law's limit, a fifth of the collision time, a tenth of the smallest radius moved by a part.
std::vector<StepLimit> time_step_limits(const StepInputs& in);

/// The smallest law limit at an overlap that was seen, given as a share of the radius; seconds 0 when no law states
/// one.
StepLimit law_limit_at(const StepInputs& in, double overlap_share);

/// The step to use: the case's own, or the smallest limit. Throws Error(Fault::settings) when the case's own is above
/// what a limit refuses, or when there is no limit and the case gives no step.
double choose_step(const StepInputs& in, const std::vector<StepLimit>& limits);

}  // namespace calx
