// whole_case.hpp: a case read for a run. Private to sim/.
#pragma once
#include "config/config.hpp"
#include "sim/run.hpp"

namespace calx {

/// The case, whose materials that can meet all have a contact: without one they would pass through each other.
CaseFile read_whole_case(const RunOptions& options);

}  // namespace calx
