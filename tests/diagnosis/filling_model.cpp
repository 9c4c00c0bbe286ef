#include "diagnosis/filling_model.hpp"

#include <cmath>
#include <complex>
#include <cstring>

#include "base/random.hpp"

namespace calx::diagnosis {

using namespace line;

namespace {

infer::Block block(const char* name, const char* kind, std::vector<double> x, std::vector<double> sd,
                   double correlation, bool log_x = false, bool ordered = false) {
  infer::Block b;
  b.name = name, b.kind = kind, b.autocorrelation = correlation, b.log_x = log_x, b.ordered = ordered;
  b.x = Eigen::Map<Vector>(x.data(), static_cast<Eigen::Index>(x.size()));
  b.sd = sd.size() == 1 ? Vector::Constant(b.x.size(), sd[0])
                        : Vector(Eigen::Map<Vector>(sd.data(), static_cast<Eigen::Index>(sd.size())));
  return b;
}

std::vector<double> places(double low, double high, int count) {
  std::vector<double> x;
  for (int k = 0; k < count; ++k) x.push_back(low + (high - low) * k / (count - 1));
  return x;
}

double degrees(double tangent) { return std::atan(tangent) * 180 / pi; }

}  // namespace

std::vector<infer::Effect> effect_library() {
  const auto effect = [](const char* id, double scale_of, bool one_sided, bool instrument = false, int components = 1) {
    infer::Effect e;
    e.id = id, e.scale = scale_of, e.one_sided = one_sided, e.instrument = instrument, e.components = components;
    return e;
  };
  return {effect("pocket under-fill with speed", 1, true),
          effect("rotor leakage", 0.25, true),
          effect("rotor eccentricity", 0.03, false, false, 2),
          effect("load cell gain drift", 0.01, false, true),
          effect("load cell zero", 0.4, false, true),
          effect("load cell lag", 0.08, true, true),
          effect("moisture ageing", 0.5, true),
          effect("attrition", 1, true),
          effect("wall friction falls with stress", 0.1, true),
          effect("air retards discharge", 0.25, true),
          effect("coarse grains at the slot", 0.25, true),
          effect("canister tilt", 0.05, false),
          effect("flat pouring", 0.12, true),
          effect("electrostatic uptake", 1.5, true),
          effect("vibration compaction", 0.015, true),
          effect("platform scale gain", 0.004, false, true)};
}

infer::Observables line_observables() {
  std::vector<double> angle;
  for (int k = 0; k < 36; ++k) angle.push_back(2 * pi * (k + 0.5) / 36);
  const double s5 = std::sqrt(5.0), s3 = std::sqrt(3.0), s2 = std::sqrt(2.0);
  infer::Observables all;
  all.blocks = {block("mass per cycle", "mass-per-cycle", places(1, cycles, cycles), {0.25}, 0.3, false, true),
                block("mass by speed", "mass-per-cycle", {4, 8, 12, 20, 30}, {0.12}, 0, true),
                block("platform mass", "mass-after-cycles", {40, 80, 120}, {1.5, 2, 2.5}, 0),
                block("flow by rotor angle", "folded-flow", angle, {0.012}, 0),
                block("discharge", "hopper-discharge", places(0.6, 11, 24), {10 / s2}, 0.5, false, true),
                block("drained angle", "drained-angle", {0}, {0.8 / s5}, 0),
                block("static angle", "static-angle", {0}, {0.8 / s5}, 0),
                block("static angle after", "static-angle", {0}, {0.8 / s3}, 0),
                block("pile profile", "pile-profile", places(-65, 65, 17), {1.2}, 0.3),
                block("residue", "residue", {0}, {0.35 / s3}, 0),
                block("bed height", "fill-height", {1, 2, 3}, {0.5}, 0),
                block("bulk density", "bulk-density", {0}, {0.008 / s5}, 0),
                block("compressibility", "compressibility", {0.5, 1, 2, 4, 6, 8, 10, 15}, {0.2 / s2}, 0, true),
                block("wall friction", "wall-friction", {1, 2, 4, 6, 8, 10}, {0.35 / s2}, 0, true)};
  all.blocks[scale].sums = all.blocks[cycle].name;
  return all;
}

Powder powder(const Vector& u) {
  return {1.21 * (1 + 0.025 * u[0]), 0.84 + 0.05 * u[1],   60 * std::exp(0.35 * u[2]),
          0.40 + 0.04 * u[3],        4 * (1 + 0.2 * u[4]), 0.97 + 0.015 * u[5]};
}

Vector simulate(const Vector& u, const std::vector<Vector>& amplitudes) {
  static const infer::Observables observables = line_observables();
  const Powder p = powder(u);
  const auto on = [&](EffectIndex e) {
    return amplitudes.empty() || amplitudes[e].size() == 0 ? 0.0 : amplitudes[e][0];
  };
  const auto x = [&](BlockIndex b) -> const Vector& { return observables.blocks[b].x; };
  const double c = p.cohesion;
  const auto mass = [&](double age, double rpm) {
    const double cohesion = c * (1 + on(ageing) * age) * (1 + 0.6 * on(attrition) * age);
    const double rho = p.density * (1 + 0.012 * on(attrition) * age);
    const double under = 1 - 0.02 * on(speed_fill) * std::pow(rpm / 20, 2);
    return pocket_volume * rho * p.fill * (1 - 0.015 * (cohesion / 60 - 1)) * under + on(leak) * reference_rpm / rpm;
  };
  std::vector<Vector> out;
  for (const infer::Block& b : observables.blocks) out.push_back(Vector::Zero(b.x.size()));
  Vector total(3);
  double sum = 0;
  for (int k = 0; k < cycles; ++k) {
    const double age = (k + 1.0) / cycles;
    const double m = mass(age, reference_rpm) - on(uptake) * std::exp(-(k + 1) / 8.0);
    sum += m;
    if ((k + 1) % 40 == 0) total[(k + 1) / 40 - 1] = sum;
    out[cycle][k] = m * (1 + on(gain_drift) * age) + on(zero_offset);
  }
  for (int k = 0; k < 5; ++k) out[speed][k] = mass(0, x(speed)[k]) + on(zero_offset);
  out[scale] = total * (1 + on(scale_gain));

  const double omega = 2 * pi * reference_rpm / 60;
  const std::complex<double> i(0, 1);
  const auto lagged = [&](double harmonic) { return 1.0 / (1.0 + i * harmonic * omega * on(lag)); };
  std::complex<double> shift = 0;
  if (!amplitudes.empty() && amplitudes[eccentricity].size() == 2)
    shift = amplitudes[eccentricity][0] - i * amplitudes[eccentricity][1];
  for (int k = 0; k < 36; ++k) {
    const double a = x(fold)[k];
    const std::complex<double> wave = 0.25 * (1 + 0.1 * (c / 60 - 1)) * lagged(6) * std::exp(6.0 * i * a) +
                                      0.06 * lagged(12) * std::exp(12.0 * i * a) + shift * lagged(1) * std::exp(i * a);
    out[fold][k] = 1 + wave.real();
  }

  // Beverloo for a slot of 50 mm by 15 mm less the empty annulus, kg/s.
  const double rate = 1.03 * p.density * 1e3 * std::sqrt(9.81) * 0.05 * std::pow(0.0115, 1.5) *
                      (1 - 0.4 * (p.friction - 0.84)) * (1 - 0.05 * (c / 60 - 1)) * std::pow(1.47, on(coarse));
  for (int k = 0; k < 24; ++k) {
    const double t = std::max(x(discharge)[k] - on(lag), 0.0), a = on(air);
    const double m = a > 1e-6 ? charge * (1 - a) / a * (std::exp(a * rate * t / charge) - 1) : rate * t;
    out[discharge][k] = 1e3 * std::min(m, charge);
  }

  const double aged = c * (1 + on(ageing)) * (1 + 0.6 * on(attrition));
  out[angle_drained][0] = degrees(p.friction * 0.985 + 0.02 * c / 60);
  out[angle_static][0] = degrees(p.friction + 0.025 * c / 60);
  out[angle_after][0] = degrees(p.friction + 0.025 * aged / 60);
  const double slope = (p.friction * 0.97 + 0.02 * c / 60) * (1 - on(flat_pour));
  const Vector away = (x(profile).array() + 0.15 * radius).abs();
  out[profile] =
      (total[0] / p.density / area * 10 + slope * (away.mean() - away.array())).matrix() + on(tilt) * x(profile);
  out[residue][0] =
      5.6 * (slope / 0.85) * std::pow(c / 60, 0.15) * (1 + 0.15 * on(coarse)) + 1.2 * on(leak) + 0.12 * on(uptake);
  for (int k = 0; k < 3; ++k)
    out[height][k] =
        total[k] / (p.density * (1 + 0.012 * on(attrition) * (k + 1) / 3)) / area * 10 * (1 - on(vibration) * k);
  out[density][0] = p.density;
  out[compression] = p.compressibility * (1 + x(compression).array() / 2).log();
  for (int k = 0; k < 6; ++k) out[wall][k] = degrees(p.wall * std::pow(x(wall)[k] / 5, -on(wall_stress)));

  Vector all(observables.rows());
  for (std::size_t b = 0; b < out.size(); ++b) all.segment(observables.first(b), observables.size(b)) = out[b];
  return all;
}

Vector seed_scatter(std::uint64_t seed, std::uint64_t stream) {
  static const infer::Observables observables = line_observables();
  Random random(seed, stream);
  Vector z(observables.rows());
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const int first = observables.first(b);
    const double common = 0.5 * random.normal();
    for (int k = 0; k < observables.size(b); ++k)
      z[first + k] = observables.blocks[b].sd[k] * (0.7 * random.normal() + common);
  }
  return z;
}

Matrix LineSimulator::run(const std::vector<infer::RunPoint>& points) {
  Matrix out(bias_.size(), static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const infer::RunPoint& point = points[k];
    std::vector<Vector> amplitudes(effect_count);
    // The part of the scatter that is this point's own follows from all of the point.
    std::uint64_t own = Random(point.seed, static_cast<std::uint64_t>(point.effect + 7)).bits();
    const auto mix = [&](const Vector& v) {
      for (double number : v) {
        std::uint64_t bits;
        std::memcpy(&bits, &number, sizeof bits);
        own = Random(own, bits).bits();
      }
    };
    mix(point.u);
    if (point.effect >= 0) amplitudes[static_cast<std::size_t>(point.effect)] = point.amplitude, mix(point.amplitude);
    out.col(static_cast<Eigen::Index>(k)) = simulate(point.u, amplitudes) + bias_ +
                                            scatter_ * std::sqrt(common_) * seed_scatter(seed_, 2 * point.seed) +
                                            scatter_ * std::sqrt(1 - common_) * seed_scatter(seed_ + 1, own | 1);
  }
  runs_ += static_cast<int>(points.size());
  return out;
}

Vector LineSimulator::instrument(const infer::RunPoint& point) {
  std::vector<Vector> amplitudes(effect_count);
  amplitudes[static_cast<std::size_t>(point.effect)] = point.amplitude;
  return simulate(point.u, amplitudes) - simulate(point.u, {});
}

}  // namespace calx::diagnosis
