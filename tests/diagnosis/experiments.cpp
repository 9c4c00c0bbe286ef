#include "diagnosis/experiments.hpp"

#include <array>
#include <cmath>

#include "base/random.hpp"

namespace calx::diagnosis {

using namespace line;

namespace {

enum Index {
  more_speeds,
  dead_weights,
  check_platform,
  dropped_weight,
  sizes_before_after,
  shear_cell_before_after,
  profile_again,
  long_fold,
  wall_at_low_stress,
  discharge_again,
  weigh_pipework,
  bed_height_again,
  spirit_level,
  experiment_count
};

constexpr std::array<double, 3> speeds = {2, 3, 40};
constexpr std::array<double, 2> low_stresses = {0.25, 0.5};

double on(const std::vector<Vector>& amplitudes, EffectIndex e) {
  return amplitudes.empty() || amplitudes[e].size() == 0 ? 0 : amplitudes[e][0];
}

Vector part(const Vector& all, BlockIndex b) {
  static const infer::Observables observables = line_observables();
  return all.segment(observables.first(b), observables.size(b));
}

Vector number(double x) { return Vector::Constant(1, x); }

double degrees(double tangent) { return std::atan(tangent) * 180 / pi; }

/// As the model has it.
Vector predicted(Index index, const Vector& u, const std::vector<Vector>& a) {
  const Powder p = powder(u);
  switch (index) {
    case more_speeds: {
      Vector y(3);
      for (std::size_t k = 0; k < 3; ++k)
        y[static_cast<int>(k)] = pocket_volume * p.density * p.fill * (1 - 0.015 * (p.cohesion / 60 - 1)) *
                                     (1 - 0.02 * on(a, speed_fill) * std::pow(speeds[k] / 20, 2)) +
                                 on(a, leak) * reference_rpm / speeds[k] + on(a, zero_offset);
      return y;
    }
    case dead_weights:
      return (Vector(2) << on(a, gain_drift), on(a, zero_offset)).finished();
    case check_platform:
      return number(on(a, scale_gain));
    case dropped_weight:
      return number(on(a, lag));
    case sizes_before_after:
      return number(-0.15 * on(a, attrition));
    case shear_cell_before_after:
      return number(std::log((1 + on(a, ageing)) * (1 + 0.6 * on(a, attrition))));
    case wall_at_low_stress: {
      Vector y(2);
      for (std::size_t k = 0; k < 2; ++k)
        y[static_cast<int>(k)] = degrees(p.wall * std::pow(low_stresses[k] / 5, -on(a, wall_stress)));
      return y;
    }
    case weigh_pipework: {
      double sum = 0;
      for (int k = 1; k <= cycles; ++k) sum += std::exp(-k / 8.0);
      return number(on(a, uptake) * sum);
    }
    case spirit_level:
      return number(on(a, tilt));
    case profile_again:
      return part(simulate(u, a), profile);
    case long_fold:
      return part(simulate(u, a), fold);
    case discharge_again:
      return part(simulate(u, a), discharge);
    default:
      return part(simulate(u, a), height);
  }
}

}  // namespace

std::vector<infer::Experiment> experiments_of(const Vector& u) {
  static const infer::Observables observables = line_observables();
  const std::vector<infer::Effect> library = effect_library();
  struct Plan {
    const char* name;
    double cost;
    std::vector<double> sd;  // one for all numbers, or one each
    int block;               // repeats it: tolerance as there; -1: new
  };
  const std::array<Plan, experiment_count> plans = {{{"more rotor speeds", 4, {0.08}, -1},
                                                     {"dead weights on the load cell", 1, {0.0005, 0.05}, -1},
                                                     {"reference weights on the platform", 1, {0.0005}, -1},
                                                     {"dropped weight", 1, {0.01}, -1},
                                                     {"particle size before and after", 3, {0.02}, -1},
                                                     {"shear cell before and after", 4, {0.08}, -1},
                                                     {"pile profile, four times", 3, {0.6}, profile},
                                                     {"flow by rotor angle, long average", 2, {0.004}, fold},
                                                     {"wall friction at low stress", 2, {0.2}, -1},
                                                     {"discharge, six times", 3, {4}, discharge},
                                                     {"weighing the pipework", 2, {0.5}, -1},
                                                     {"bed height, five times", 2, {0.2}, height},
                                                     {"spirit level", 0.5, {0.005}, -1}}};
  std::vector<infer::Experiment> out;
  for (int x = 0; x < experiment_count; ++x) {
    const Plan& plan = plans[static_cast<std::size_t>(x)];
    infer::Experiment e;
    e.name = plan.name, e.cost = plan.cost;
    e.base = predicted(static_cast<Index>(x), u, {});
    const auto n = e.base.size();
    e.sd.resize(n);
    for (int k = 0; k < n; ++k) e.sd[k] = plan.sd[plan.sd.size() == 1 ? 0 : static_cast<std::size_t>(k)];
    e.tolerance = 0.35 * (plan.block < 0 ? e.sd : observables.blocks[static_cast<std::size_t>(plan.block)].sd);
    e.sensitivities.resize(n, parameters);
    for (int k = 0; k < parameters; ++k)
      e.sensitivities.col(k) = (predicted(static_cast<Index>(x), u + Vector::Unit(parameters, k), {}) -
                                predicted(static_cast<Index>(x), u - Vector::Unit(parameters, k), {})) /
                               2;
    for (std::size_t f = 0; f < library.size(); ++f) {
      Matrix g(n, library[f].components);
      for (int c = 0; c < library[f].components; ++c) {
        std::vector<Vector> amplitudes(effect_count);
        amplitudes[f] = library[f].scale * Vector::Unit(library[f].components, c);
        g.col(c) = (predicted(static_cast<Index>(x), u, amplitudes) - e.base) / library[f].scale;
      }
      e.signatures.push_back(g);
    }
    out.push_back(e);
  }
  return out;
}

Vector perform(std::size_t index, const Vector& u, const std::vector<Vector>& a, const std::vector<double>& alien,
               const Forms& forms, Random& random) {
  const Powder p = powder(u);
  const Vector all = plant(u, a, alien, forms, 2);
  Vector y;
  const double worn = on(a, attrition) * (1 - std::exp(-cycles / forms.attrition_time)) /
                      (1 - std::exp(-cycles / (0.8 * forms.attrition_time)));
  switch (static_cast<Index>(index)) {
    case more_speeds:
      y.resize(3);
      for (std::size_t k = 0; k < 3; ++k)
        y[static_cast<int>(k)] =
            pocket_volume * (1 - (alien.empty() ? 0 : alien[bad_pocket]) / 6) * p.density * p.fill /
                (1 + 0.015 * (p.cohesion / 60 - 1)) *
                (1 - 0.02 * on(a, speed_fill) * std::exp(forms.speed_constant * (1.0 / 20 - 1 / speeds[k]))) +
            on(a, leak) * reference_rpm / speeds[k] * (1 + forms.leak_head) + on(a, zero_offset);
      break;
    case sizes_before_after:
      y = number(-0.15 * worn);
      break;
    case shear_cell_before_after:
      y = number(std::log((1 + on(a, ageing)) * (1 + 0.6 * worn)));
      break;
    case dropped_weight:
      y = number(1.05 * on(a, lag));
      break;
    case wall_at_low_stress:
      y.resize(2);
      for (std::size_t k = 0; k < 2; ++k) {
        const double falls = std::log(5.0) * (std::pow(low_stresses[k] / 5, -forms.stress_power) - 1) /
                             (std::pow(5, forms.stress_power) - 1);
        y[static_cast<int>(k)] = degrees(p.wall * (1 + on(a, wall_stress) * falls));
      }
      break;
    case weigh_pipework: {
      double sum = 0;
      for (int k = 1; k <= cycles; ++k) sum += 1.25 * std::pow(1 + k / forms.uptake_time, -forms.uptake_power);
      y = number(on(a, uptake) * sum);
      break;
    }
    case profile_again:
      y = part(all, profile);
      break;
    case long_fold:
      y = part(all, fold);
      break;
    case discharge_again:
      y = part(all, discharge);
      break;
    case bed_height_again:
      y = part(all, height);
      break;
    default:
      y = predicted(static_cast<Index>(index), u, a);
  }
  const Vector sd = experiments_of(u)[index].sd;
  for (int k = 0; k < y.size(); ++k) {
    const double n = random.normal();
    const double chi = n * n - 2 * std::log((1 - random.uniform()) * (1 - random.uniform()));
    y[k] += sd[k] * random.normal() / std::sqrt(chi / 5) / std::sqrt(5.0 / 3);
  }
  return y;
}

}  // namespace calx::diagnosis
