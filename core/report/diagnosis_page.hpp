// diagnosis_page.hpp: the page of a diagnosis, from the files that calx diagnose wrote.
#pragma once
#include <string>

namespace calx {

/// Writes dir/report.html from diagnosis.json, cost.json, runs.csv and the extended cases. Returns the page's path.
/// Throws Error(Fault::files) when diagnosis.json cannot be read; what else is missing leaves a sentence.
std::string write_diagnosis_report(const std::string& dir);

}  // namespace calx
