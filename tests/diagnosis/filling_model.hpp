// filling_model.hpp: a stand-in for the simulator: a filling line in closed form, with six nuisance parameters, sixteen
// effects and the observables of a plant. Formulas and numbers are assumptions; the plant it is compared with has
// others.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "infer/simulator.hpp"

namespace calx::diagnosis {

using infer::Matrix;
using infer::Vector;

namespace line {
constexpr int cycles = 120, parameters = 6;
constexpr double reference_rpm = 12, pocket_volume = 46.9 /* cm^3 per turn */, charge = 3.3 /* kg */;
constexpr double area = 303 /* cm^2 */, radius = 70 /* mm */;
constexpr double pi = 3.14159265358979323846;
}  // namespace line

/// Effects in the order of the library.
enum EffectIndex {
  speed_fill,
  leak,
  eccentricity,
  gain_drift,
  zero_offset,
  lag,
  ageing,
  attrition,
  wall_stress,
  air,
  coarse,
  tilt,
  flat_pour,
  uptake,
  vibration,
  scale_gain,
  effect_count
};
std::vector<infer::Effect> effect_library();

/// Blocks in the order of the observables: per-cycle mass, speed sweep, platform scale, folded flow, discharge,
/// drained, static and after-test angle, pile profile, residue, bed heights, bulk density, compressibility, wall
/// friction.
enum BlockIndex {
  cycle,
  speed,
  scale,
  fold,
  discharge,
  angle_drained,
  angle_static,
  angle_after,
  profile,
  residue,
  height,
  density,
  compression,
  wall,
  block_count
};
/// Without measured numbers.
infer::Observables line_observables();

/// Nuisance parameters in their own units from standardised ones.
struct Powder {
  double density;          // g/cm^3
  double friction;         // tangent of the inner angle
  double cohesion;         // Pa
  double wall;             // wall friction
  double compressibility;  // %
  double fill;             // of a pocket
};
Powder powder(const Vector& u);

/// Mean over seeds of all observables, stacked; amplitudes[e] is empty where effect e is off.
Vector simulate(const Vector& u, const std::vector<Vector>& amplitudes);

/// Scatter of one run by its seed: white 0.7 and common 0.5 declared sd per block.
Vector seed_scatter(std::uint64_t seed, std::uint64_t stream);

/// The stand-in as the diagnosis sees it, with runs that scatter and a hidden numerical bias.
class LineSimulator : public infer::Simulator {
 public:
  /// common: correlation of runs of one seed; seed: of this stand-in; bias: added to every run; scatter: over the
  /// usual.
  LineSimulator(double common, std::uint64_t seed, Vector bias, double scatter)
      : common_(common), seed_(seed), bias_(std::move(bias)), scatter_(scatter) {}
  int parameters() const override { return line::parameters; }
  Matrix run(const std::vector<infer::RunPoint>& points) override;
  Vector instrument(const infer::RunPoint& point) override;
  int runs() const { return runs_; }

 private:
  double common_;
  std::uint64_t seed_;
  Vector bias_;
  double scatter_;
  int runs_ = 0;
};

}  // namespace calx::diagnosis
