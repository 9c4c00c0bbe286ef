// report.hpp: one self-contained HTML page from a run's folder. Reads only what io/ wrote; no network, no other file.
#pragma once
#include <string>

namespace calx {

/// Writes dir/report.html from summary.json, case.json, series/*.csv, fields.json and particles.h5; works for a run
/// that is still going. Returns the page's path. Throws Error(Fault::files).
std::string write_report(const std::string& dir);

}  // namespace calx
