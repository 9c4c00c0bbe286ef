// plant.hpp: the hidden world that is measured: pocket by pocket, other functional forms than the model's, drawn anew
// for each study; effects that are in no library; noise with heavy tails and autocorrelation.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/filling_model.hpp"

namespace calx {
class Random;
}

namespace calx::diagnosis {

/// Effects that no library holds, with the family of term that describes each.
enum Alien {
  bad_pocket,
  cycle_step,
  diurnal,
  sawtooth,
  blocked,
  yield_plateau,
  stall,
  crater,
  slump,
  pulsing,
  apex_shift,
  start_up,
  alien_count
};
const char* alien_name(Alien alien);
/// Families that count as right, in the words of infer::Term.
std::vector<std::string> alien_families(Alien alien);
double alien_scale(Alien alien);

/// Functional forms and places of one study.
struct Forms {
  explicit Forms(Random& random);
  double ageing_time, attrition_time, drift_power, leak_head, uptake_power, uptake_time, speed_constant, lag_poles;
  double air_power, stress_power, apex_rounding, base;
  double step_at, period, phase, teeth, plateau_at, stall_at, crater_width, slump_at, pulse_rate, start_up_at;
  int pocket;
  std::uint64_t events;  // seed of blocked cycles
};

/// Means of all observables. alien: strengths of Alien effects, empty for none.
Vector plant(const Vector& u, const std::vector<Vector>& amplitudes, const std::vector<double>& alien,
             const Forms& forms, int campaign);

/// Noise of one campaign: t with 5 degrees of freedom, autocorrelated as declared, in nominal sd.
Vector plant_noise(Random& random);

}  // namespace calx::diagnosis
