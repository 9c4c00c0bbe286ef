// simulator.hpp: how the diagnosis sees a simulator: runs at given parameters, with or without one effect, by seed.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "infer/observables.hpp"

namespace calx::infer {

/// A candidate cause. Its amplitude is zero where the effect is off.
struct Effect {
  std::string id;
  double scale = 1;         // typical amplitude, in the unit of the effect's parameter
  int components = 1;       // 2: a vector in a plane, such as an eccentricity with its phase
  bool one_sided = false;   // physics allows amplitudes >= 0 only; a single component
  bool instrument = false;  // acts on recorded series, so its signature is exact and costs no run of the engine
};

/// One run: parameters, effect, seed. The same seed gives common random numbers.
struct RunPoint {
  Vector u;          // nuisance parameters, standardised: prior mean 0, sd 1
  int effect = -1;   // index of an effect, -1: none
  Vector amplitude;  // of its components
  std::uint64_t seed = 1;
};

class Simulator {
 public:
  virtual ~Simulator() = default;
  /// Number of nuisance parameters.
  virtual int parameters() const = 0;
  /// Step of the central difference by a parameter, in its prior sd: larger where one sd changes less than runs
  /// scatter.
  virtual double step(int) const { return 1; }
  /// One column per point, one row per number of the observables. Pure: a point gives the same numbers every time. A
  /// column of NaN: the run with this effect cannot be made at this amplitude; others must be finite.
  virtual Matrix run(const std::vector<RunPoint>& points) = 0;
  /// Change of the observables by an instrument effect, exact: applied to the recorded series of the run without it.
  virtual Vector instrument(const RunPoint& point) = 0;
};

}  // namespace calx::infer
