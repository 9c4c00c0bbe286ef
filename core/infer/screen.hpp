// screen.hpp: single numbers that no effect and no smooth discrepancy explains: events, such as a blocked cycle.
#pragma once
#include <vector>

#include "infer/bank.hpp"
#include "infer/budget.hpp"

namespace calx::infer {

struct Event {
  int row = 0;
  double z = 0;  // leave-one-out standardised residual
};

/// Inflates the noise of rows whose leave-one-out residual, under the error budget with every signature and smooth
/// discrepancy free, is larger than options.screen_above; returns them.
std::vector<Event> screen(const LinearModel& model, const Bank& bank, const Matrix& systematic, View& view,
                          const Options& options);

}  // namespace calx::infer
