#include "diagnosis/plant.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"

namespace calx::diagnosis {

using namespace line;

namespace {

double degrees(double tangent) { return std::atan(tangent) * 180 / pi; }

/// 0 at the start, 1 after all cycles.
double saturating(double done, double time) { return (1 - std::exp(-done / time)) / (1 - std::exp(-cycles / time)); }

double interpolate(const std::vector<double>& y, double place) {
  const double last = static_cast<double>(y.size() - 1);
  place = std::clamp(place, 0.0, last);
  const auto k = static_cast<std::size_t>(std::min(place, last - 1));
  return y[k] + (place - static_cast<double>(k)) * (y[k + 1] - y[k]);
}

}  // namespace

const char* alien_name(Alien alien) {
  constexpr std::array<const char*, alien_count> names = {
      "one bad pocket", "step in cycle", "diurnal swing", "hopper sawtooth", "blocked cycles", "yield plateau",
      "feed stall",     "crater",        "slump",         "pulsing",         "apex shift",     "late start-up"};
  return names[alien];
}

std::vector<std::string> alien_families(Alien alien) {
  switch (alien) {
    case bad_pocket:
      return {"bump", "periodic"};
    case cycle_step:
      return {"step"};
    case diurnal:
      return {"periodic"};
    case sawtooth:
      return {"sawtooth", "periodic"};
    case blocked:
      return {"events"};
    case yield_plateau:
    case slump:
      return {"hinge"};
    case stall:
      return {"step"};
    case crater:
      return {"bump"};
    case pulsing:
      return {"periodic", "rough"};
    case apex_shift:
      return {"shift", "drift", "bump", "hinge", "periodic"};
    default:
      return {"step", "decay"};
  }
}

double alien_scale(Alien alien) {
  constexpr std::array<double, alien_count> scales = {0.06, 0.35, 0.35, 0.5, 1, 0.9, 0.5, 4, 0.15, 30, 8, 0.4};
  return scales[alien];
}

Forms::Forms(Random& random)
    : ageing_time(random.uniform(40, 150)),
      attrition_time(random.uniform(35, 120)),
      drift_power(random.uniform(0.75, 1.4)),
      leak_head(random.uniform(0.1, 0.5)),
      uptake_power(random.uniform(1.0, 1.5)),
      uptake_time(random.uniform(4, 7)),
      speed_constant(random.uniform(65, 95)),
      lag_poles(random.uniform() < 0.5 ? 1 : 2),
      air_power(random.uniform(0.65, 1.1)),
      stress_power(random.uniform(0.7, 1.2)),
      apex_rounding(random.uniform(1.5, 4)),
      base(random.uniform(-1, 1)),
      step_at(random.uniform(30, 100)),
      period(random.uniform(50, 110)),
      phase(random.uniform(0, 2 * pi)),
      teeth(std::array<double, 3>{30, 40, 60}[random.bits() % 3]),
      plateau_at(random.uniform(4, 8)),
      stall_at(random.uniform(3, 7)),
      crater_width(random.uniform(6, 13)),
      slump_at(random.uniform(5, 30)),
      pulse_rate(random.uniform(0.3, 0.6)),
      start_up_at(random.uniform(15, 60)),
      pocket(static_cast<int>(random.bits() % 6)),
      events(random.bits()) {}

Vector plant(const Vector& u, const std::vector<Vector>& amplitudes, const std::vector<double>& alien,
             const Forms& forms, int campaign) {
  static const infer::Observables observables = line_observables();
  const Powder p = powder(u);
  const auto on = [&](EffectIndex e) {
    return amplitudes.empty() || amplitudes[e].size() == 0 ? 0.0 : amplitudes[e][0];
  };
  const auto strange = [&](Alien a) { return alien.empty() ? 0.0 : alien[a]; };
  const auto x = [&](BlockIndex b) -> const Vector& { return observables.blocks[b].x; };
  const double c = p.cohesion;
  std::vector<Vector> out;
  for (const infer::Block& b : observables.blocks) out.push_back(Vector::Zero(b.x.size()));

  const auto mass = [&](double done, double rpm) {
    const double cohesion = c * (1 + on(ageing) * saturating(done, forms.ageing_time)) *
                            (1 + 0.6 * on(attrition) * saturating(done, forms.attrition_time));
    const double rho = p.density * (1 + 0.012 * on(attrition) * saturating(done, forms.attrition_time));
    // Equal to the model's square law at 20 rpm.
    const double under = 1 - 0.02 * on(speed_fill) * std::exp(forms.speed_constant * (1.0 / 20 - 1 / rpm));
    double m = 0;
    for (int pocket = 0; pocket < 6; ++pocket)
      m += pocket_volume / 6 * (pocket == forms.pocket ? 1 - strange(bad_pocket) : 1.0) * rho * p.fill * under /
           (1 + 0.015 * (cohesion / 60 - 1));
    const double head = done > 0 ? 1 - std::fmod(done - 1, 40.0) / 40 : 1;
    return m + on(leak) * reference_rpm / rpm * (1 + forms.leak_head * (2 * head - 1));
  };
  std::array<bool, cycles> is_blocked{};
  Random events(forms.events, static_cast<std::uint64_t>(campaign));
  for (int k = 0; k < 5; ++k) is_blocked[events.bits() % cycles] = true;
  double sum = 0;
  Vector total(3);
  for (int k = 0; k < cycles; ++k) {
    const double n = k + 1;
    double m = mass(n, reference_rpm) - on(uptake) * 1.25 * std::pow(1 + n / forms.uptake_time, -forms.uptake_power);
    m += n >= forms.step_at ? strange(cycle_step) : 0;
    m += strange(sawtooth) * (std::fmod(n - 1, forms.teeth) / (forms.teeth - 1) - 0.5);
    m -= is_blocked[static_cast<std::size_t>(k)] ? strange(blocked) : 0;
    m += strange(start_up) * std::tanh((n - forms.start_up_at) / 8);
    sum += m;
    if ((k + 1) % 40 == 0) total[(k + 1) / 40 - 1] = sum;
    out[cycle][k] = m * (1 + on(gain_drift) * std::pow(n / cycles, forms.drift_power)) + on(zero_offset) +
                    strange(diurnal) * std::sin(2 * pi * n / forms.period + forms.phase);
  }
  for (int k = 0; k < 5; ++k) out[speed][k] = mass(0, x(speed)[k]) + on(zero_offset);
  out[scale] = total * (1 + on(scale_gain));

  // Flow over one turn in fine steps, twice round, through the lag's poles.
  constexpr int fine = 720;
  std::vector<double> q(fine);
  double size = 0, turn = 0;
  if (!amplitudes.empty() && amplitudes[eccentricity].size() == 2) {
    size = amplitudes[eccentricity].norm();
    turn = std::atan2(amplitudes[eccentricity][1], amplitudes[eccentricity][0]);
  }
  for (int k = 0; k < fine; ++k) {
    const double a = 2 * pi * k / fine;
    double flow = 1 + 0.25 * (1 + 0.1 * (c / 60 - 1)) * std::cos(6 * a) + 0.06 * std::cos(12 * a + 0.1 * forms.base) +
                  size * (std::cos(a - turn) + 0.25 * std::cos(2 * (a - turn)));
    if (static_cast<int>(a / (2 * pi / 6) + 0.5) % 6 == forms.pocket) flow *= 1 - strange(bad_pocket);
    q[static_cast<std::size_t>(k)] = flow;
  }
  double mean = 0;
  for (double flow : q) mean += flow / fine;
  const double step = 60 / reference_rpm / fine;
  for (int pole = 0; pole < forms.lag_poles && on(lag) > 0; ++pole) {
    const double keep = std::exp(-step / (on(lag) / forms.lag_poles));
    double y = q[0];
    for (int k = 0; k < 2 * fine; ++k) y = keep * y + (1 - keep) * q[static_cast<std::size_t>(k % fine)];
    for (double& flow : q) flow = y = keep * y + (1 - keep) * flow;
  }
  q.push_back(q[0]);
  for (int k = 0; k < 36; ++k) out[fold][k] = interpolate(q, x(fold)[k] / (2 * pi) * fine) / mean;

  const double rate = 1.03 * p.density * 1e3 * std::sqrt(9.81) * 0.05 * std::pow(0.0115, 1.5) *
                      (1 - 0.38 * (p.friction - 0.84)) / (1 + 0.05 * (c / 60 - 1)) * std::pow(1.44, on(coarse));
  std::vector<double> drained = {0};
  for (double t = 0.01; t < 14; t += 0.01) {
    const double head = std::max(1 - drained.back() / charge, 0.0);
    double r = rate * std::sqrt(std::max(1 - 1.8 * on(air) * std::pow(head, forms.air_power), 0.05)) *
               (1 - std::exp(-t / (0.02 * (1.2 + forms.base))));
    if (t > forms.stall_at && t < forms.stall_at + strange(stall)) r = 0;
    drained.push_back(std::min(drained.back() + r * 0.01, charge));
  }
  for (int k = 0; k < 24; ++k) {
    const double t = x(discharge)[k];
    out[discharge][k] = 1e3 * interpolate(drained, (t - on(lag)) / 0.01) +
                        strange(pulsing) * std::exp(-t / 8) * std::sin(2 * pi * forms.pulse_rate * t);
  }

  const double done = cycles;
  const double aged = c * (1 + on(ageing) * saturating(done, forms.ageing_time)) * (1 + 0.6 * on(attrition));
  out[angle_drained][0] = degrees(p.friction * 0.985 + 0.02 * c / 60) + 0.1 * forms.base;
  out[angle_static][0] = degrees(p.friction + 0.025 * c / 60) - 0.1 * forms.base;
  out[angle_after][0] = degrees(p.friction + 0.025 * aged / 60) - 0.1 * forms.base;
  const double slope = p.friction * 0.97 + 0.02 * c / 60;
  const double rounding = forms.apex_rounding + 0.72 * on(flat_pour) * radius;
  Vector pile(17);
  for (int k = 0; k < 17; ++k) {
    const double place = x(profile)[k], from = place + 0.15 * radius - 20 * on(tilt) - strange(apex_shift);
    pile[k] = -std::hypot(from, rounding) * slope * (1 - 0.35 * on(flat_pour)) -
              strange(crater) * std::exp(-0.5 * std::pow(from / forms.crater_width, 2)) +
              strange(slump) * std::max(place - forms.slump_at, 0.0);
  }
  out[profile] = (total[0] / p.density / area * 10 + pile.array() - pile.mean()).matrix() + on(tilt) * x(profile);
  out[residue][0] =
      5.6 * (slope * (1 - 0.8 * on(flat_pour)) / 0.85) * std::pow(c / 60, 0.15) * (1 + 0.15 * on(coarse)) + on(leak) +
      0.12 * on(uptake);
  constexpr std::array<double, 3> worn = {0.5, 0.8, 1}, packed = {0, 1, 1.5};
  for (std::size_t k = 0; k < 3; ++k)
    out[height][static_cast<int>(k)] = total[static_cast<int>(k)] /
                                       (p.density * (1 + 0.012 * on(attrition) * worn[k])) / area * 10 *
                                       (1 - 1.25 * on(vibration) * packed[k]);
  out[density][0] = p.density;
  for (int k = 0; k < 8; ++k) {
    const double stress = x(compression)[k];
    out[compression][k] =
        p.compressibility * std::log(1 + stress / 2) * (1 + 0.01 * forms.base * std::sin(1.3 * std::log1p(stress))) -
        strange(yield_plateau) * std::max(stress - forms.plateau_at, 0.0) / 9;
  }
  for (int k = 0; k < 6; ++k) {
    const double stress = x(wall)[k];
    // Equal to the model's power law at 1 and 5 kPa.
    const double falls =
        std::log(5.0) * (std::pow(stress / 5, -forms.stress_power) - 1) / (std::pow(5, forms.stress_power) - 1);
    out[wall][k] = degrees(p.wall * (1 + on(wall_stress) * falls)) + 0.1 * forms.base * std::cos(stress / 3);
  }
  Vector all(observables.rows());
  for (std::size_t b = 0; b < out.size(); ++b) all.segment(observables.first(b), observables.size(b)) = out[b];
  return all;
}

Vector plant_noise(Random& random) {
  static const infer::Observables observables = line_observables();
  Vector all(observables.rows());
  for (std::size_t b = 0; b < observables.blocks.size(); ++b) {
    const double a = observables.blocks[b].autocorrelation;
    double before = 0;
    for (int k = 0; k < observables.size(b); ++k) {
      const double n = random.normal();
      const double chi = n * n - 2 * std::log((1 - random.uniform()) * (1 - random.uniform()));
      const double z = random.normal() / std::sqrt(chi / 5) / std::sqrt(5.0 / 3);
      before = k == 0 ? z : a * before + std::sqrt(1 - a * a) * z;
      all[observables.first(b) + k] = observables.blocks[b].sd[k] * before;
    }
  }
  return all;
}

}  // namespace calx::diagnosis
