// sample_run.hpp: a complete run's folder made without a simulation, for the report's tests and for looking at the
// page.
#pragma once
#include <cstddef>
#include <string>

namespace calx_test {

struct SampleOptions {
  std::size_t grains = 6000;
  double frames_every = 0.5;   // s; 0: no particles.h5
  double sample_every = 0.01;  // s
};
/// Fills dir: summary.json, case.json, series, fields.json and, with frames, particles.h5.
void write_sample_run(const std::string& dir, const SampleOptions& options = {});

}  // namespace calx_test
