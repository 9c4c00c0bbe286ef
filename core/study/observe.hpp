// observe.hpp: figures of a finished run, as a study's observables ask for them.
#pragma once
#include <string>
#include <vector>

#include "study/study.hpp"

namespace calx {

/// The figures of the observable in the run's folder, in its unit: the last value for a scalar, else one for each
/// measured x, interpolated where the series first passes it; beyond its ends by half a sample, the end. NaN where the
/// run gives none (a series that ends before x, a pile that was never there). Reads summary.json, or series/SENSOR.csv,
/// or a curve of fields.json. Throws Error(Fault::files) for a folder without them.
std::vector<double> observe(const std::string& folder, const StudyObservable& observable);

/// y where a series first passes x, between its places; beyond its ends by half a sample, the end; else NaN.
double passing(const std::vector<double>& xs, const std::vector<double>& ys, double x);

/// Why observe() gives no number there, as a sentence without its full stop.
std::string why_not(const std::string& folder, const StudyObservable& o);

}  // namespace calx
