// whole_case.hpp: a case read for a run.
#pragma once
#include "config/config.hpp"
#include "sim/run.hpp"

namespace calx {

/// The case itself, if all materials that can meet have a contact: without one they would pass through each other.
/// Throws Error(Fault::settings).
CaseFile whole_case(CaseFile file);
CaseFile read_whole_case(const RunOptions& options);

}  // namespace calx
