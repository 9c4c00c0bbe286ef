// calibration_page.hpp: the page of a calibration, from the files that calx calibrate wrote.
#pragma once
#include <string>

namespace calx {

/// Writes dir/report.html from calibration.json, samples.csv and cost.json. Returns the page's path. Throws
/// Error(Fault::files) when calibration.json cannot be read; what else is missing leaves a sentence.
std::string write_calibration_report(const std::string& dir);

}  // namespace calx
